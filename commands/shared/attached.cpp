// SPDX-License-Identifier: MIT
#include "commands/shared/attached.hpp"

#include "loop/recorded_plant.hpp"
#include "processes/bus_line.hpp"
#include "watch/session_judge.hpp"

namespace mixloop {
namespace {

/// After its END, what another core sends of the session may still be under way.
constexpr auto kUnderWay = std::chrono::milliseconds(200);

}  // namespace

RunFault no_plant_heard(const Bus& bus, const std::string& which) {
  return {"lost_peer",
          "no plant" + which + " is heard on " + bus.channel("STATE") +
              "; start mixloop-plant, -controller and -planner with the same experiment, in the same "
              "network namespace"};
}

Result attached(const Experiment& experiment, const BusOptions& options, nanoseconds first_wait,
                nanoseconds patience, const StopSwitch& stop) {
  const Plan plan = make_plan(experiment);
  if (!experiment.plant.sensors.unmeasured.empty())
    throw InputError(
        "not_measured", experiment.path.place,
        "the plant's sensors leave free coordinates unmeasured (plant.sensors.free), so what is heard "
        "of it doesn't say how it moves; expected --over-bus, or all of them measured");
  require_room(experiment, plan);
  Bus bus(options);
  SessionJudge judge(experiment, plan);
  say_complaint(judge.equations().complaint());
  bus.subscribe<&SessionJudge::on_state>(bus.channel("STATE"), &judge);
  bus.subscribe<&SessionJudge::on_command>(bus.channel("COMMAND"), &judge);
  bus.subscribe<&SessionJudge::on_control>(bus.channel("SIM_CONTROL"), &judge);

  const Instant start = now();
  Instant news = start;
  while (!judge.ended() && !stop.turned()) {
    const std::int64_t before = judge.latest();
    bus.wait(now() + std::chrono::milliseconds(100), stop);
    if (judge.latest() != before) news = now();
    if (now() - news > (judge.session() != 0 ? patience : first_wait))
      throw judge.session() != 0 ? RunFault("lost_peer", "the plant fell silent on " + bus.channel("STATE"))
                                 : no_plant_heard(bus, " of this experiment");
  }
  const Instant end = now();
  while (!judge.over() && !stop.turned() && now() < end + kUnderWay) bus.wait(end + kUnderWay, stop);
  const double wall_time = std::chrono::duration<double>(end - start).count();
  return judge.finish(stop.turned() && !judge.ended(), wall_time);
}

}  // namespace mixloop
