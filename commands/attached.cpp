// SPDX-License-Identifier: MIT
#include "commands/attached.hpp"

#include "loop/recorded_plant.hpp"
#include "processes/bus_line.hpp"
#include "runtime/bus/wire.hpp"

namespace mixloop {
namespace {

/// Listens to one session from its first STATE to its END.
class AttachedListener {
 public:
  AttachedListener(const Experiment& experiment, const Plan& plan, Bus& bus)
      : plan_(plan),
        recorder_(experiment, plan),
        config_(config_of(common_ground(experiment))),
        states_(experiment.scene->n()),
        commands_(experiment.scene->n_u()),
        controls_(experiment.scene->n()) {
    bus.subscribe<&AttachedListener::on_state>(bus.channel("STATE"), this);
    bus.subscribe<&AttachedListener::on_command>(bus.channel("COMMAND"), this);
    bus.subscribe<&AttachedListener::on_control>(bus.channel("SIM_CONTROL"), this);
    say_complaint(recorder_.equations().complaint());
  }

  bool over() const { return over_; }
  bool heard() const { return session_ != 0; }
  std::int64_t latest() const { return latest_; }

  Result result(const Experiment& experiment, bool interrupted, double wall_time) {
    if (interrupted) recorder_.interrupted();
    Measures measures = recorder_.measures();
    const std::int64_t missing = plan_.ticks() + 1 - complete_;
    if (missing > 0) measures.trajectory_sha256.clear();
    Result result = result_of(experiment, measures, "attached", wall_time);
    result.missing_ticks = missing;
    result.session = session_;
    return result;
  }

 private:
  void on_state(Bytes bytes) {
    if (states_.read(bytes)) return;
    const state_t& state = states_.message;
    if (session_ == 0 && state.config != config_) return;  // another experiment's plant
    if (session_ == 0) session_ = state.session;
    if (state.session != session_ || state.seq <= latest_ || state.seq > plan_.ticks()) return;
    latest_ = state.seq;
    if ((state.flags & state_t::FLAG_SAFE_STATE) != 0 && !safe_) {
      safe_ = true;
      recorder_.made_safe(latest_);
    }
    over_ = over_ || !recorder_.state(latest_, state.psi_measured, state.psid_measured, 0.0);
  }

  void on_command(Bytes bytes) {
    if (commands_.read(bytes)) return;
    const command_t& command = commands_.message;
    if (command.session != session_ || command.seq != latest_ || latest_ <= latest_complete_) return;
    latest_complete_ = latest_;
    ++complete_;
    over_ = over_ || !recorder_.command(latest_, command.tau_commanded, command.tau_commanded) ||
            latest_ == plan_.ticks();
  }

  void on_control(Bytes bytes) {
    if (controls_.read(bytes)) return;
    over_ = over_ ||
            (controls_.message.session == session_ && controls_.message.action == sim_control_t::ACTION_END);
  }

  const Plan& plan_;
  Recorder recorder_;
  std::int64_t config_;
  Inbox<state_t> states_;
  Inbox<command_t> commands_;
  Inbox<sim_control_t> controls_;
  std::int64_t session_ = 0, latest_ = -1, latest_complete_ = -1, complete_ = 0;
  bool over_ = false, safe_ = false;
};

}  // namespace

RunFault no_plant_heard(const Bus& bus, const std::string& which) {
  return {"lost_peer",
          "no plant" + which + " is heard on " + bus.channel("STATE") +
              "; start mixloop-plant, -controller and -planner with the same experiment, in the same "
              "network namespace"};
}

Result attached(const Experiment& experiment, const BusOptions& options, nanoseconds patience,
                const StopSwitch& stop) {
  const Plan plan = make_plan(experiment);
  require_memory(experiment, plan);
  Bus bus(options);
  AttachedListener listener(experiment, plan, bus);
  const Instant start = now();
  Instant news = start;
  while (!listener.over() && !stop.turned()) {
    const std::int64_t before = listener.latest();
    bus.wait(now() + std::chrono::milliseconds(100), stop);
    if (listener.latest() != before) news = now();
    if (now() - news > patience)
      throw listener.heard() ? RunFault("lost_peer", "the plant fell silent on " + bus.channel("STATE"))
                             : no_plant_heard(bus, " of this experiment");
  }
  return listener.result(experiment, stop.turned(), std::chrono::duration<double>(now() - start).count());
}

}  // namespace mixloop
