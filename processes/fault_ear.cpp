// SPDX-License-Identifier: MIT
#include "processes/fault_ear.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

void say_refused(const std::string& why) { fmt::print(stderr, "mixloop-plant: FAULT refused: {}\n", why); }

/// "1 payload, 2 spring": the parameters as `mixloop control fault parameter` counts them.
std::string counted_parameters(const Scene& scene) {
  std::string text;
  for (std::size_t i = 0; i < scene.parameters.size(); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", i + 1, scene.parameters[i].name);
  return text.empty() ? "none" : text;
}

/// -1 where there is none.
int payload_in(const Scene& scene) {
  const auto found = std::find_if(scene.parameters.begin(), scene.parameters.end(),
                                  [](const auto& parameter) { return parameter.name == "payload"; });
  return found == scene.parameters.end() ? -1 : static_cast<int>(found - scene.parameters.begin());
}

}  // namespace

FaultEar::FaultEar(Bus& bus, const RecordedPlant& run, bool allowed, std::int64_t config, PlantReport& report)
    : bus_(bus),
      channel_(bus.channel("FAULT")),
      run_(run),
      allowed_(allowed),
      config_(config),
      report_(report),
      inbox_(static_cast<int>(run.plant().measured().size())),
      answer_(static_cast<int>(run.plant().measured().size())) {
  heard_.reserve(Faults::kWaiting);
  bus_.subscribe<&FaultEar::on_fault>(channel_, this);
}

bool FaultEar::is_news(Endpoint sender, std::int64_t count) {
  auto known = std::find_if(counts_.begin(), counts_.end(),
                            [sender](const Count& c) { return c.latest >= 0 && c.sender == sender; });
  if (known == counts_.end()) {
    known = counts_.begin() + static_cast<std::ptrdiff_t>(senders_++ % counts_.size());
    *known = {.sender = sender};
  }
  if (count <= known->latest) return false;
  known->latest = count;
  return true;
}

void FaultEar::on_fault(const Received& received) {
  const auto reject = [this](Reject cause) { report_.rejects.count(cause); };
  if (const auto cause = inbox_.read(received.data)) return reject(*cause);
  const fault_t& message = inbox_.message;
  if (message.session != report_.session) return reject(Reject::session);
  if (message.kind < fault_t::KIND_NONE) return;  // an answer, its own too
  if (message.config != config_) return reject(Reject::config);
  if (!is_news(received.sender, message.seq)) return reject(Reject::stale);
  if (!allowed_) {
    ++report_.refused_faults;
    say_refused("this plant was started without --allow-faults");
    return answer(fault_t::KIND_NOT_ALLOWED);
  }
  try {
    take(message);
    answer(fault_t::KIND_TAKEN);
  } catch (const InputError& error) {
    ++report_.refused_faults;
    say_refused(error.message);
    answer(fault_t::KIND_REFUSED);
  }
}

/// Throws InputError where it can't be.
void FaultEar::take(const fault_t& message) {
  const Experiment& experiment = run_.experiment();
  const Scene& scene = *experiment.scene;
  const Fault fault = fault_in(message);
  const FaultGround ground{.scene = scene,
                           .friction = scene.has_friction() || experiment.plant.actuators.has_friction(),
                           .rate_hz = experiment.rate_hz,
                           .values = experiment.plant_parameters};
  const auto parameters = static_cast<int>(scene.parameters.size());
  if (fault.target == Fault::Target::parameter && (fault.index < 0 || fault.index >= parameters))
    throw InputError(
        "out_of_range", {},
        message.index == -1
            ? fmt::format("the scene has no parameter that is called payload; its parameters: {}",
                          counted_parameters(scene))
            : fmt::format("there is no parameter {}; the scene's parameters: {}", message.index + 1,
                          counted_parameters(scene)));
  require_possible(fault, ground);
  if (fault.target == Fault::Target::sensor)
    if (const auto& without = experiment.plant.sensors.unmeasured;
        std::ranges::count(without, fault.index) > 0)
      throw InputError("not_measured", {}, "that coordinate isn't measured: it has no sensor");
  if (const char* reason = run_.deadlines().no_room_for(fault, heard_))
    throw InputError("out_of_range", {}, reason);
  // Also a plant that is paused can be healed, however much it has heard in its tick.
  if (run_.plant().heals_at_once(fault)) {
    if (healed_already(fault)) return;
  } else if (heard_.size() >= Faults::kWaiting) {
    throw InputError("out_of_range", {}, fmt::format("{} came in one tick already", heard_.size()));
  }
  heard_.push_back(fault);
}

bool FaultEar::healed_already(const Fault& fault) const {
  const auto latest = std::find_if(heard_.rbegin(), heard_.rend(), [&fault](const Fault& heard) {
    return heard.target == fault.target && heard.index == fault.index;
  });
  return latest != heard_.rend() && run_.plant().heals_at_once(*latest);
}

Fault FaultEar::fault_in(const fault_t& message) const {
  const auto target = static_cast<Fault::Target>(message.target);
  const bool payload = target == Fault::Target::parameter && message.index == -1;
  return {.target = target,
          .kind = static_cast<Fault::Kind>(message.kind),
          .index = payload ? payload_in(*run_.experiment().scene) : message.index,
          .magnitude = message.magnitude,
          .at = 1e-6 * static_cast<double>(message.utime),
          .duration = message.duration};
}

void FaultEar::answer(std::int8_t what) {
  answer_.message = inbox_.message;
  answer_.message.kind = what;
  bus_.publish(channel_, answer_.encode());
}

}  // namespace mixloop
