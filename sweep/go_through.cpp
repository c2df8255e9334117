// SPDX-License-Identifier: MIT
#include "sweep/go_through.hpp"

namespace mixloop {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kTelling(100);
constexpr std::chrono::seconds kSyncing(1);

}  // namespace

void go_through(const Sweep& sweep, const SweepFolder& folder, const Part& part, const Engine& engine, int threads,
                const std::function<bool()>& goes_on, const std::function<void(const SweepProgress&)>& told) {
  Journal journal(folder.journal(), sweep.sha256());
  const std::size_t values = sweep.telling().columns.size();
  Dispenser dispenser(without(sweep.runs(), KeptRuns(folder.journals(), sweep.sha256(), values).done()),
                      {batch_for(sweep.runs()), part.index, part.of});
  SweepProgress progress{.of = dispenser.total()};
  std::atomic<std::int64_t> done{0};
  Crew crew(sweep.setup(), sweep.telling(), engine, threads,
            {.next = [&] { return dispenser.next(); },
             .brought =
                 [&](const std::vector<Outcome>& outcomes) {
                   journal.append(outcomes);
                   done += std::ssize(outcomes);
                 },
             .goes_on = goes_on});
  const auto began = Clock::now();
  auto synced = began;
  const auto tell = [&] {
    progress.done = done;
    const double elapsed = std::chrono::duration<double>(Clock::now() - began).count();
    progress.rate = elapsed > 0 ? static_cast<double>(progress.done) / elapsed : 0;
    told(progress);
  };
  while (!crew.ended_within(kTelling)) {
    tell();
    if (Clock::now() - synced < kSyncing) continue;
    journal.sync();
    synced = Clock::now();
  }
  tell();
  journal.sync();
}

}  // namespace mixloop
