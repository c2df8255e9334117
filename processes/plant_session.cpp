// SPDX-License-Identifier: MIT
#include "processes/plant_session.hpp"

#include <fmt/format.h>

#include "loop/review.hpp"
#include "notation/long_work.hpp"
#include "processes/bus_figures.hpp"
#include "processes/keep.hpp"
#include "processes/plant_on_bus.hpp"
#include "processes/result_json.hpp"
#include "processes/standard_output.hpp"
#include "processes/summary.hpp"
#include "runtime/protocol/lockstep_plant.hpp"
#include "runtime/protocol/real_time_plant.hpp"

namespace mixloop {

namespace {

/// No tick in real time may wait for a disk.
const Experiment& with_room(const PlantLine& line, const Experiment& experiment, const Plan& plan) {
  if (line.real_time) require_memory(experiment, plan);
  return experiment;
}

}  // namespace

PlantSession::PlantSession(const PlantLine& line, const Experiment& experiment, const Plan& plan,
                           ReportLine& report)
    : line_(line), run_(with_room(line, experiment, plan), plan), report_(report) {}

Ending PlantSession::run(Bus& bus, const StopSwitch& stop, std::int64_t session, std::int64_t next_session) {
  say_complaint(run_.plant().equations().complaint());
  if (!run_.begin())
    throw RunFault(
        "diverged",
        "the start is already farther from the path than limits.position_error or limits.motor_error");
  return line_.real_time ? run_as<RealTimePlant, RealTimeHardware>(bus, stop, session, next_session)
                         : run_as<LockstepPlant, LockstepHardware>(bus, stop, session, next_session);
}

template <class Runner, class Hardware>
Ending PlantSession::run_as(Bus& bus, const StopSwitch& stop, std::int64_t session,
                            std::int64_t next_session) {
  Hardware hardware(run_, [this](std::int64_t k) { return goes_on(k); });
  const PlantOptions options = plant_options(line_, run_.experiment(), run_.plan().ticks(), session);
  Runner runner(bus, stop, options, hardware);
  hardware.listen(bus, line_.allow_faults, options.config, runner.report());
  line_.take_rights("mixloop-plant", true);
  return drive(runner, next_session);
}

Ending PlantSession::drive(PlantRunner& runner, std::int64_t next_session) {
  bus_ = &runner.report();
  try {
    const Ending ending = runner.run();
    if (ending == Ending::reset) {
      runner.send_reset(next_session);
      return ending;
    }
    if (ending == Ending::interrupted || ending == Ending::stopped) run_.recorder().interrupted();
    finish(nullptr);
    return ending;
  } catch (const RunFault& fault) {
    run_.recorder().interrupted();
    finish(&fault);
    throw;
  }
}

/// Tick k is recorded: whether there is a next one.
bool PlantSession::goes_on(std::int64_t k) {
  report_.tick(k);
  if (k != run_.plan().ticks()) return true;
  if (!line_.hold) return false;
  finish(nullptr);
  if (line_.report_fd < 0)
    fmt::print(stderr, "mixloop-plant: {}; Ctrl-C ends it\n",
               run_.plan().has_path() ? "holding the end point" : "going on past the end");
  return true;
}

/// Judges and keeps it, once; what was recorded before a fault too.
void PlantSession::finish(const RunFault* fault) {
  if (finished_) return;
  finished_ = true;
  const Uninterrupted whole;  // what there is is told and kept
  const Experiment& experiment = run_.experiment();
  Result result = result_of(experiment, run_.recorder().measures(),
                            line_.real_time ? "real_time" : "lockstep", run_.plant().equations().evaluation(),
                            std::chrono::duration<double>(bus_->wall_time).count());
  // One that was stopped is not looked back on, and one that holds on has deadlines to meet.
  if (const bool stopped = !fault && result.run->measures.interrupted_at; !stopped && !line_.hold)
    result.warnings = review(experiment, run_.plan(), run_.recorder());
  if (const auto rival = describe(bus_->rival, line_.bus.prefix + "COMMAND"); !rival.empty()) {
    if (!result.warnings) result.warnings.emplace();
    result.warnings->push_back(rival);
  }
  result.session = bus_->session;
  result.bus = bus_figures(*bus_);
  if (line_.real_time) add_deadlines(*result.bus, *bus_, run_.deadlines(), experiment.deadline.safe_state);
  if (fault) result = failed(std::move(result), *fault);
  status_ = result.judged.exit_status;
  if (!line_.out.empty()) {
    report_.keeping();
    keep(line_.out, run_, result);
  }
  report_.result(result);
  if (fault) return;  // the command line tells it
  if (line_.json)
    print_json(json_of(result));
  else if (line_.report_fd < 0)
    fmt::print("{}", summary(experiment, result));
  flush_standard_output();
}

}  // namespace mixloop
