// SPDX-License-Identifier: MIT
// JSON Schema of what a person writes, from the lists of keys that the readers read by.
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "dynamics/scene/scene_keys.hpp"
#include "loop/experiment_keys.hpp"
#include "processes/command_line.hpp"
#include "sweep/request.hpp"

namespace mixloop {
namespace {

using Json = nlohmann::ordered_json;

Json schema_of(const Keys& keys);

/// A scalar is what YAML makes of its text: a number without a unit is one, with a unit it is a string.
Json schema_of(const Form& form) {
  const auto all = [](const std::vector<Form>& forms) {
    Json list = Json::array();
    for (const Form& one : forms) list.push_back(schema_of(one));
    return list;
  };
  switch (form.kind) {
    case Form::Kind::any:
      return true;
    case Form::Kind::text:
      return {{"type", {"string", "number", "boolean"}}};
    case Form::Kind::number:
      return {{"type", {"number", "string"}}};
    case Form::Kind::flag:
      return {{"enum", {true, false, "yes", "no", "on", "off"}}};
    case Form::Kind::whole:
      return {{"type", {"integer", "string"}}};
    case Form::Kind::word:
      return {{"enum", form.words}};
    case Form::Kind::named:
      return {{"type", "object"}, {"additionalProperties", schema_of(form.of.front())}};
    case Form::Kind::mapping:
      return schema_of(form.keys());
    case Form::Kind::one_of:
      return {{"anyOf", all(form.of)}};
    case Form::Kind::list:
      break;
  }
  const Json item = schema_of(form.of.front()), list = {{"type", "array"}, {"items", item}};
  const Form::Kind kind = form.of.front().kind;
  if (kind == Form::Kind::mapping || kind == Form::Kind::one_of) return list;
  return {{"anyOf", {item, list}}};
}

Json schema_of(const Keys& keys) {
  Json properties = Json::object(), required = Json::array();
  for (const Key& key : keys.all) {
    properties[key.name] = schema_of(key.form);
    if (key.required) required.push_back(key.name);
  }
  Json schema = {
      {"title", keys.what}, {"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  Json all = {{"required", required}};
  for (const std::string& one : keys.either) all["oneOf"].push_back({{"required", {one}}});
  if (keys.unless.empty())
    schema.update(all);
  else
    schema["anyOf"] = {{{"required", {keys.unless}}}, all};
  return schema;
}

}  // namespace

void add_schema_command(CLI::App& command, int& status) {
  auto kind = std::make_shared<std::string>();
  command.add_option("kind", *kind, "scene, experiment or sweep")
      ->required()
      ->check(CLI::IsMember({"scene", "experiment", "sweep"}).description(""))
      ->type_name("KIND");
  command.footer(
      "An editor completes and checks by it; what numbers, units and formulas mean is checked when a file is "
      "read.\n"
      "Example, for an editor with the YAML language server:\n"
      "  mixloop schema experiment > experiment.schema.json\n"
      "  # yaml-language-server: $schema=experiment.schema.json     in the file's first line");
  command.callback([kind, &status] {
    Json json = {{"$schema", "http://json-schema.org/draft-07/schema#"}};
    json.update(schema_of(*kind == "scene"   ? scene_keys()
                          : *kind == "sweep" ? sweep_keys()
                                             : experiment_keys()));
    print_json(json);
    status = 0;
  });
}

}  // namespace mixloop
