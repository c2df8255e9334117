// SPDX-License-Identifier: MIT
#include "commands/shared/launched.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <optional>

#include "commands/shared/awaited.hpp"
#include "commands/shared/children.hpp"
#include "commands/shared/overheard.hpp"
#include "commands/shared/progress.hpp"
#include "commands/shared/warnings.hpp"
#include "loop/inputs.hpp"
#include "loop/recorded_plant.hpp"
#include "processes/called_as.hpp"
#include "processes/command_line.hpp"
#include "processes/keep.hpp"
#include "processes/report_line.hpp"
#include "runtime/bus/log_writer.hpp"
#include "runtime/bus/multicast_route.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/protocol/session.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;

/// How long a process may take to leave once the plant has ended or a stop was ordered. Keeping what was
/// recorded takes as long as it takes.
constexpr auto kGrace = 3s;

nanoseconds in_nanoseconds(double seconds) { return nanoseconds(std::llround(1e9 * seconds)); }

/// A run of the processes: their pipes, their ends, and what the plant reports.
class Run {
 public:
  Run(const Experiment& experiment, const Launch& launch, const StopSwitch& stop,
      const std::function<void(const Result&)>& at_end, std::int64_t ticks)
      : launch_(launch), stop_(stop), at_end_(at_end), progress_(experiment.name, ticks, experiment.rate_hz) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw RunFault("cannot_start", std::string("no pipe: ") + std::strerror(errno));
    report_ = ends[0];
    fcntl(report_, F_SETFL, O_NONBLOCK);
    // A stranger's plant draws its own, and the others take that.
    const std::int64_t session = absent("plant") ? 0 : draw_session();
    if (!launch.without.empty() && !launch.quiet) awaited_.emplace(launch, session);
    if (absent("plant"))
      overheard_.emplace(experiment, launch.bus, in_nanoseconds(launch.first_wait),
                         in_nanoseconds(launch.patience));
    children_.reserve(launch.order.size());
    // Without a path there is nothing to plan.
    for (const auto& name : launch.order)
      if (!absent(name) && (name != "planner" || experiment.has_path()))
        children_.emplace_back(name, command(name, session, ends[1]), name == "plant" ? ends[1] : -1);
    close(ends[1]);
  }
  ~Run() { close(report_); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Throws RunFault for a process that failed; then the plant's result, if it told one, is `told()`.
  Result wait() {
    while (
        std::any_of(children_.begin(), children_.end(), [](const Child& child) { return child.running(); })) {
      wait_for_news();
      if (awaited_ && !stopping_ && !awaited_->look()) awaited_.reset();
      read_report();
      for (auto& child : children_) hear(child);
      order_stop_where_asked();
      kill_where_overdue();
    }
    read_report();
    progress_.clear();
    return verdict();
  }

  const std::optional<Result>& told() const { return result_; }

 private:
  bool absent(const std::string& name) const {
    return std::find(launch_.without.begin(), launch_.without.end(), name) != launch_.without.end();
  }

  std::vector<std::string> command(const std::string& name, std::int64_t session, int report) const {
    std::vector<std::string> words = {own_folder() + "/mixloop-" + name,
                                      launch_.experiment,
                                      "--parent",
                                      std::to_string(getpid()),
                                      "--session",
                                      std::to_string(session),
                                      "--lcm-url",
                                      launch_.bus.url,
                                      "--channel-prefix",
                                      launch_.bus.prefix,
                                      "--patience",
                                      fmt::format("{}", launch_.patience),
                                      "--first-wait",
                                      fmt::format("{}", launch_.first_wait),
                                      "--evaluation",
                                      std::string(name_of(launch_.evaluation))};
    for (const auto& set : launch_.sets) words.insert(words.end(), {"--set", set});
    if (launch_.real_time) words.emplace_back("--realtime");
    // The planner is a tick ahead: nobody waits for it.
    if (launch_.spin && name != "planner") words.emplace_back("--spin");
    if (name != "plant") return words;
    if (launch_.paused) words.emplace_back("--paused");
    if (launch_.hold) words.emplace_back("--hold");
    if (!launch_.speed.empty()) words.insert(words.end(), {"--speed", launch_.speed});
    words.insert(words.end(), {"--report-fd", std::to_string(report)});
    if (launch_.truth) words.emplace_back("--truth");
    if (launch_.allow_faults) words.emplace_back("--allow-faults");
    if (!launch_.out.empty()) words.insert(words.end(), {"--out", launch_.out});
    return words;
  }

  void wait_for_news() {
    std::vector<pollfd> fds;
    if (!reported_all_) fds.push_back({report_, POLLIN, 0});
    if (!stopping_) fds.push_back({stop_.fd(), POLLIN, 0});
    for (const auto& child : children_) {
      if (child.running()) fds.push_back({child.pidfd(), POLLIN, 0});
      if (child.errors() >= 0) fds.push_back({child.errors(), POLLIN, 0});
    }
    poll(fds.data(), fds.size(), 200);
  }

  void read_report() {
    char buffer[4096];
    for (ssize_t size = 0; !reported_all_ && (size = read(report_, buffer, sizeof buffer)) >= 0;) {
      if (size == 0) reported_all_ = true;
      reported_.append(buffer, static_cast<std::size_t>(size));
    }
    for (std::size_t end = reported_.find('\n'); end != std::string::npos; end = reported_.find('\n')) {
      Reported line = reported_in(reported_.substr(0, end));
      reported_.erase(0, end + 1);
      if (line.keeping) keeping_ = true;
      if (line.tick && !launch_.quiet) progress_.at(*line.tick / 64 * 64);
      if (line.result) {
        result_ = std::move(line.result);
        keeping_ = false;
        if (deadline_) deadline_ = now() + kGrace;
        progress_.clear();
        if (at_end_) at_end_(*result_);
      }
    }
  }

  void hear(Child& child) {
    child.read_errors([&](const std::string& line) {
      if (!launch_.quiet && !stopping_) {
        progress_.clear();
        fmt::print(stderr, "{}\n", line);
      }
    });
    if (!child.running() || !child.reap()) return;
    if (!deadline_) deadline_ = now() + kGrace;
    // Peers leave after the plant; one that leaves before it, or by a signal, takes the others along.
    const bool early = child.name() != "plant" && !stopping_ && !result_;
    // Our own signal may have met it before it could heed one.
    const bool by_us = stopping_ && (child.killed_by() == SIGINT || child.killed_by() == SIGTERM);
    const bool killed = child.killed_by() != 0 && !by_us;
    const bool failed = killed || (early && child.exit_status() != 0 && child.exit_status() != kInterrupted);
    if (failed && !first_failure_) first_failure_ = &child;
    if (killed || early) order_stop(killed ? SIGTERM : 0);
    // A plant that was stopped before it had anything told nobody.
    if (stopped_ && child.name() == "plant" && !result_)
      for (const auto& other : children_) other.signal(SIGINT);
  }

  void order_stop_where_asked() {
    if (stop_.turned() && !stopping_) {
      stopped_ = true;
      order_stop(SIGINT);
    }
  }

  /// The plant first: it tells the others, and keeps what it has.
  void order_stop(int number) {
    if (stopping_) return;
    if (number != 0) {
      stopping_ = true;
      bool has_plant = false;
      for (const auto& child : children_)
        if (child.name() == "plant" && child.running()) child.signal(number), has_plant = true;
      if (!has_plant)
        for (const auto& child : children_) child.signal(number);
    }
    deadline_ = now() + kGrace;
  }

  /// SIGTERM after the grace, SIGKILL after as much again.
  void kill_where_overdue() {
    if (!deadline_ || now() < *deadline_) return;
    for (const auto& child : children_)
      if (child.name() != "plant" || !keeping_) child.signal(terminated_ ? SIGKILL : SIGTERM);
    terminated_ = true;
    stopping_ = true;
    deadline_ = now() + kGrace;
  }

  Result verdict() {
    if (first_failure_) throw_failure(*first_failure_);
    if (overheard_) return overheard_->finish();
    if (stopped_ && !result_)
      return {.judged = {.verdict = Verdict::interrupted, .exit_status = kInterrupted}};
    for (const auto& child : children_)
      if (child.name() == "plant" && !result_) throw_failure(child);
    for (const auto& child : children_)
      if (child.name() == "plant" && child.exit_status() == kRunFault &&
          !result_->run->measures.diverged_at && !result_->run->measures.safe_at)
        throw_failure(child);
    return result_.value_or(Result{});
  }

  [[noreturn]] static void throw_failure(const Child& child) {
    const std::string words = child.last_words();
    const std::string how =
        child.killed_by() != 0
            ? fmt::format("was killed by signal {} ({})", child.killed_by(), strsignal(child.killed_by()))
            : fmt::format("ended with status {}", child.exit_status());
    throw RunFault("process_failed", fmt::format("mixloop-{} {}{}{}", child.name(), how,
                                                 words.empty() ? "" : "; its last words: ", words));
  }

  const Launch& launch_;
  const StopSwitch& stop_;
  const std::function<void(const Result&)>& at_end_;
  Progress progress_;
  std::optional<Awaited> awaited_;
  std::optional<Overheard> overheard_;  ///< a stranger's plant
  std::vector<Child> children_;
  int report_ = -1;
  bool reported_all_ = false;
  std::string reported_;
  bool keeping_ = false;  ///< the plant is writing its results
  std::optional<Result> result_;
  const Child* first_failure_ = nullptr;
  bool stopped_ = false;  ///< by the user
  bool stopping_ = false;
  bool terminated_ = false;
  std::optional<Instant> deadline_;
};

/// What is kept of a run whose processes failed says so too.
Result waited_for(Run& run, const Launch& launch) {
  try {
    return run.wait();
  } catch (const RunFault& fault) {
    if (run.told() && !launch.out.empty()) keep_result(launch.out, failed(*run.told(), fault));
    throw;
  }
}

}  // namespace

Result launched(const Experiment& experiment, const Launch& launch, const StopSwitch& stop,
                const std::function<void(const Result&)>& at_end) {
  // Everything that can be refused is refused here, before a process is started.
  if (experiment.plant.continuous)
    throw InputError("out_of_range", {launch.experiment},
                     "plant.control is 'continuous': over the bus a torque is held from tick to tick; "
                     "expected 'held' (mixloop simulate runs both)");
  if (!experiment.has_path() && std::ranges::count(launch.without, "planner") > 0)
    throw InputError(
        "no_path", {"--without"},
        "the experiment has a duration in place of a path, and no planner to leave out; expected "
        "controller or plant");
  const Plan plan = make_plan(experiment);
  if (launch.real_time) require_memory(experiment, plan);
  require_multicast_route(multicast_group(launch.bus.url));
  if (!launch.out.empty()) {
    begin_run_folder(launch.out);
    keep_inputs(launch.out, experiment);  // also where a stranger's plant keeps nothing
  }
  // The programs are compiled once, not by each process.
  say_complaint(make_plant(experiment, plan).equations().complaint());
  say_complaint(make_controller(experiment).equations().complaint());
  auto warnings = warnings_of(experiment, plan, launch.quiet);

  std::optional<LogWriter> log;
  if (!launch.out.empty()) log.emplace(launch.bus, std::filesystem::path(launch.out) / "run.lcmlog");
  Run run(experiment, launch, stop, at_end, plan.ticks());
  Result result = waited_for(run, launch);
  if (result.warnings) {  // the plant's own, of the run that it had
    say(*result.warnings, launch.quiet);
    warnings.insert(warnings.end(), result.warnings->begin(), result.warnings->end());
  }
  result.warnings = std::move(warnings);
  if (log) {
    const LogSummary summary = log->finish();
    result.log = {.file = "run.lcmlog", .events = summary.events, .missing_ticks = summary.missing_ticks};
  }
  return result;
}

}  // namespace mixloop
