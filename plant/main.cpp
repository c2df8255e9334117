// SPDX-License-Identifier: MIT
// mixloop-plant: the simulated hardware, on the bus. It owns the clock and keeps the result.
#include <fmt/format.h>

#include <csignal>

#include "loop/keep.hpp"
#include "loop/result.hpp"
#include "loop/truth.hpp"
#include "runtime/lockstep_plant.hpp"
#include "tools/bus_line.hpp"
#include "tools/report_line.hpp"
#include "tools/speed.hpp"

namespace mixloop {
namespace {

struct Options : PeerLine {
  std::string speed = "max";
  std::string out;
  bool truth = false;
  bool hold = false;
  int report_fd = -1;
};

template <class Message>
void fill(Message& message, const Recorder& recorder, std::int64_t k, const Truth& truth) {
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), std::begin(to)); };
  copy(recorder.psi(k), message.psi);
  copy(recorder.psid(k), message.psid);
  copy(truth.psidd, message.psidd);
  copy(recorder.applied(k), message.tau_applied);
  copy(truth.position, message.position);
  copy(truth.velocity, message.velocity);
  copy(truth.acceleration, message.acceleration);
  message.kinetic_energy = truth.kinetic_energy;
  message.potential_energy = truth.potential_energy;
  message.work = truth.work;
  const auto commanded = recorder.commanded(k), applied = recorder.applied(k);
  message.flags =
      std::equal(commanded.begin(), commanded.end(), applied.begin()) ? 0 : truth_t::FLAG_SATURATED;
}

/// One run of the plant on the bus.
class PlantProcess {
 public:
  explicit PlantProcess(const Options& options)
      : options_(options),
        loaded_(options.load()),
        plan_(make_plan(loaded_)),
        experiment_(with_integrator_settled(loaded_, plan_)),
        plant_(make_plant(experiment_, plan_)),
        recorder_(experiment_, plan_),
        truth_(experiment_, recorder_),
        report_(options.report_fd) {
    if (!options.out.empty()) prepare_folder(options.out);
    stop_.turn_on_signals();
  }

  int run() {
    if (!recorder_.state(0, plant_.psi(), plant_.psid(), plant_.work()))
      throw RunFault("diverged", "the start is already farther from the path than limits.position_error");
    Bus bus(options_.bus);
    LockstepPlant lockstep(bus, stop_, lockstep_options(), side());
    lockstep_ = &lockstep;
    try {
      const Ending ending = lockstep.run();
      if (ending == Ending::interrupted || ending == Ending::stopped) recorder_.interrupted();
    } catch (const RunFault& fault) {
      recorder_.interrupted();
      finish(&fault);
      throw;
    }
    finish(nullptr);
    return status_;
  }

 private:
  LockstepOptions lockstep_options() const {
    return {.n = experiment_.scene->n(),
            .last_tick = plan_.ticks(),
            .rate_hz = experiment_.rate_hz,
            .speed = speed_of(options_.speed),
            .session = options_.session,
            .config = config_of(experiment_),
            .truth = options_.truth,
            .hold = options_.hold,
            .first_wait = options_.first_wait_ns(),
            .patience = options_.patience_ns()};
  }

  PlantSide side() {
    return {.measure =
                [this](std::int64_t, std::span<double> psi, std::span<double> psid) {
                  std::copy(plant_.psi().begin(), plant_.psi().end(), psi.begin());
                  std::copy(plant_.psid().begin(), plant_.psid().end(), psid.begin());
                },
            .advance = [this](std::int64_t k, std::span<const double> tau) { return advance(k, tau); },
            .truth = [this](std::int64_t k, truth_t& message) { fill(message, recorder_, k, truth_.at(k)); }};
  }

  bool advance(std::int64_t k, std::span<const double> tau) {
    plant_.command(tau);
    if (!recorder_.command(k, tau, plant_.applied())) return false;
    report_.tick(k);
    if (k == plan_.ticks()) {
      if (!options_.hold) return true;
      finish(nullptr);
      if (options_.report_fd < 0)
        fmt::print(stderr, "mixloop-plant: holding the end point; Ctrl-C ends it\n");
    }
    plant_.advance();
    return recorder_.state(k + 1, plant_.psi(), plant_.psid(), plant_.work());
  }

  /// Judges and keeps the run, once; what was recorded before a fault is kept too.
  void finish(const RunFault* fault) {
    if (finished_) return;
    finished_ = true;
    const LockstepReport& bus = lockstep_->report();
    const auto seconds = [](nanoseconds time) { return std::chrono::duration<double>(time).count(); };
    auto result = result_json(experiment_, recorder_.measures(), "lockstep", seconds(bus.wall_time));
    result["missed_deadlines"] = 0;  // lockstep waits
    result["resent"] = bus.resent;
    result["round_trip_p50"] = seconds(bus.round_trip.quantile(0.5));
    result["round_trip_p99"] = seconds(bus.round_trip.quantile(0.99));
    result["round_trip_max"] = seconds(bus.round_trip.max());
    result["session"] = bus.session;
    result["slipped"] = seconds(bus.slipped);
    result["rejected"] = bus.rejects.total();
    result["joined_late"] = bus.joined_late > 0;
    if (fault) {
      result["verdict"] = "fault";
      result["exit_status"] = kRunFault;
      result["error"] = {{"code", fault->code}, {"message", fault->what()}, {"where", ""}};
    }
    status_ = result.at("exit_status").get<int>();
    if (!options_.out.empty()) keep(options_.out, experiment_, plan_, recorder_, result);
    report_.result(result);
    if (fault) return;  // the command line tells it
    if (options_.json)
      print_json(result);
    else if (options_.report_fd < 0)
      fmt::print("{}", summary(experiment_, result));
    std::fflush(stdout);
  }

  Options options_;
  Experiment loaded_;
  Plan plan_;
  Experiment experiment_;
  Plant plant_;
  Recorder recorder_;
  TruthReader truth_;
  ReportLine report_;
  StopSwitch stop_;
  LockstepPlant* lockstep_ = nullptr;
  bool finished_ = false;
  int status_ = 0;
};

}  // namespace
}  // namespace mixloop

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  int status = 0;
  mixloop::Options options;
  CLI::App app(
      "mixloop-plant: the simulated hardware of an experiment, on the LCM bus. It owns the clock: tick k is "
      "plant time k / rate.");
  mixloop::add_peer_options(app, options);
  app.add_option("--speed", options.speed,
                 "plant seconds a real second, or max (the default): as fast as it goes")
      ->type_name("X");
  app.add_flag("--hold", options.hold, "go on holding the end point until stopped");
  app.add_flag("--truth", options.truth, "publish TRUTH, which no controller may read");
  app.add_option("--out", options.out, "keep result.json and trajectory.csv in this folder")
      ->type_name("DIR");
  app.add_option("--report-fd", options.report_fd, "tell `mixloop run` over this file descriptor")->group("");
  app.footer(
      "Publishes STATE, waits for COMMAND; start mixloop-controller and mixloop-planner on the same "
      "experiment, in any order.\n"
      "Exit status: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time, 130 interrupted.");
  app.callback([&] { status = mixloop::PlantProcess(options).run(); });
  return mixloop::run_command_line(argc, argv, app, status);
}
