// SPDX-License-Identifier: MIT
#include "loop/inputs.hpp"

#include <nlohmann/json.hpp>

#include "loop/output_file.hpp"

namespace mixloop {

nlohmann::ordered_json json_of(const Node& node) {
  switch (node.kind) {
    case Node::Kind::empty:
      return nullptr;
    case Node::Kind::scalar:
      return node.text;
    case Node::Kind::sequence: {
      auto list = nlohmann::ordered_json::array();
      for (const auto& item : node.items) list.push_back(json_of(*item));
      return list;
    }
    case Node::Kind::mapping:
      break;
  }
  auto mapping = nlohmann::ordered_json::object();
  for (const auto& entry : node.entries) mapping[entry.key] = json_of(*entry.value);
  return mapping;
}

std::string line_of(const Node& node) { return json_of(node).dump(); }

namespace {

/// What is watched over or can't be passed, in SI, a value a motor; those that there are.
nlohmann::ordered_json limits_json(const Experiment& experiment) {
  auto json = nlohmann::ordered_json::object();
  if (experiment.has_path()) json["position_error"] = experiment.position_error_limit;
  const auto add = [&](const char* key, const auto& values) {
    if (!values.empty()) json[key] = values;
  };
  add("torque", experiment.plant.torque_limit);
  add("commanded_torque", experiment.controller.safety.torque_limit);
  add("planned_torque", experiment.limits.torque);
  add("velocity", experiment.controller.safety.velocity_limit);
  add("planned_velocity", experiment.limits.velocity);
  add("position", experiment.controller.safety.position_range);
  return json;
}

nlohmann::ordered_json faults_json(const Experiment& experiment) {
  auto json = nlohmann::ordered_json::array();
  for (const Fault& fault : experiment.plant.faults.scheduled) {
    json.push_back({{"text", to_string(fault, *experiment.scene)}, {"at", fault.at}});
    if (fault.duration > 0) json.back()["until"] = fault.at + fault.duration;
  }
  return json;
}

}  // namespace

nlohmann::ordered_json inputs_json(const Experiment& experiment) {
  nlohmann::ordered_json json = {{"name", experiment.name},
                                 {"rate", experiment.rate_hz},
                                 {"experiment", json_of(*experiment.document)},
                                 {"scene", json_of(*experiment.scene_document)},
                                 {"limits", limits_json(experiment)},
                                 {"faults", faults_json(experiment)},
                                 {"plant_parameters", nlohmann::ordered_json::object()}};
  for (std::size_t i = 0; i < experiment.scene->parameters.size(); ++i)
    json["plant_parameters"][experiment.scene->parameters[i].name] = experiment.plant_parameters[i];
  return json;
}

std::string keep_inputs(const std::filesystem::path& folder, const Experiment& experiment) {
  return write_file(folder / "inputs.json", inputs_json(experiment).dump(2) + "\n");
}

}  // namespace mixloop
