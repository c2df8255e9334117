// SPDX-License-Identifier: MIT
#include "loop/inputs.hpp"

#include <fstream>

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

nlohmann::ordered_json inputs_json(const Experiment& experiment) {
  nlohmann::ordered_json json = {{"name", experiment.name},
                                 {"rate", experiment.rate_hz},
                                 {"experiment", json_of(*experiment.document)},
                                 {"scene", json_of(*experiment.scene_document)},
                                 {"plant_parameters", nlohmann::ordered_json::object()}};
  for (std::size_t i = 0; i < experiment.scene->parameters.size(); ++i)
    json["plant_parameters"][experiment.scene->parameters[i].name] = experiment.plant_parameters[i];
  return json;
}

void keep_inputs(const std::filesystem::path& folder, const Experiment& experiment) {
  const auto file = folder / "inputs.json";
  std::ofstream out(file);
  out << inputs_json(experiment).dump(2) << '\n';
  if (!out.flush()) throw RunFault("cannot_write", "cannot write " + file.string());
}

}  // namespace mixloop
