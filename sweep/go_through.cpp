// SPDX-License-Identifier: MIT
#include "sweep/go_through.hpp"

namespace mixloop {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kTelling(100), kLooking(1);
constexpr std::chrono::seconds kSyncing(1);

/// Every so often.
class Every {
 public:
  explicit Every(Clock::duration period) : period_(period) {}
  bool due() {
    if (Clock::now() - last_ < period_) return false;
    last_ = Clock::now();
    return true;
  }

 private:
  Clock::duration period_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace

void go_through(const Sweep& sweep, const SweepFolder& folder, const Part& part, const Going& how) {
  Journal journal(folder.journal(), sweep.sha256());
  const std::size_t values = sweep.telling().columns.size();
  Work work({without(sweep.runs(), KeptRuns(folder.journals(), sweep.sha256(), values).done()),
             {batch_for(sweep.runs(), how.engine.batch()), part.index, part.of}},
            [&](std::span<const Outcome> outcomes) { journal.append(outcomes); });
  std::optional<Leading> leading;
  if (how.peers != nullptr) leading.emplace(*how.peers, sweep, work, how.patience, how.said);
  Crew crew(sweep.setup(), sweep.telling(), how.engine, how.threads,
            {.next = [&] { return work.take_or_wait(); },
             .brought = [&](const std::vector<Outcome>& outcomes) { work.bring(0, outcomes); },
             .goes_on = how.goes_on});
  // Threads that wait for runs to come back must not be waited for.
  const struct Stop {
    Work& work;
    ~Stop() { work.stop(); }
  } stop{work};

  const auto began = Clock::now();
  Every telling(kTelling), syncing(kSyncing);
  const auto tell = [&] {
    const double elapsed = std::chrono::duration<double>(Clock::now() - began).count();
    how.told({.done = work.done(),
              .of = work.total(),
              .rate = elapsed > 0 ? static_cast<double>(work.done()) / elapsed : 0});
  };
  for (;;) {
    const bool ended = crew.ended_within(leading ? kLooking : kTelling);
    if (ended && (!leading || leading->is_over())) break;
    if (ended) std::this_thread::sleep_for(kLooking);
    if (leading) leading->look();
    if (!how.goes_on()) {
      work.stop();
      if (leading) leading->stop();
    }
    if (telling.due()) tell();
    if (syncing.due()) journal.sync();
  }
  if (leading) leading->end();
  tell();
  journal.sync();
}

}  // namespace mixloop
