// SPDX-License-Identifier: MIT
#include "dynamics/explanation/explanation.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "processes/command_line.hpp"

namespace mixloop {
namespace {

struct ExplainLine : CommonOptions {
  std::string scene;
};

nlohmann::json counts(const OperationCount& count) {
  return {{"add", count.add},       {"mul", count.mul},     {"div", count.div},       {"sqrt", count.sqrt},
          {"sincos", count.sincos}, {"other", count.other}, {"flops", count.flops()}, {"fused", count.fused}};
}

nlohmann::json as_json(const Explanation& explanation) {
  nlohmann::json json;
  for (const auto& quantity : explanation.quantities)
    json["quantities"][std::string(name_of(quantity.purpose))] = {{"literal", counts(quantity.literal)},
                                                                  {"pruned", counts(quantity.run)},
                                                                  {"set_up", counts(quantity.set_up)},
                                                                  {"tracing", name_of(quantity.tracing)},
                                                                  {"evaluation", nullptr}};
  for (const auto& quantity : explanation.quantities)
    if (quantity.evaluation)
      json["quantities"][std::string(name_of(quantity.purpose))]["evaluation"] =
          name_of(*quantity.evaluation);
  json["reasons"] = explanation.reasons;
  return json;
}

void print_table(const Explanation& explanation) {
  fmt::print("{:<26}{:>18}{:>18}{:>8}   {:<13}{}\n", "operations + sincos", "literal", "pruned", "", "traced",
             "runs as");
  for (const auto& quantity : explanation.quantities) {
    const auto text = [](const OperationCount& count) {
      return fmt::format("{} + {}", count.flops(), count.sincos);
    };
    fmt::print("{:<26}{:>18}{:>18} {:>6.1f}x   {:<13}{}\n", name_of(quantity.purpose), text(quantity.literal),
               text(quantity.run),
               static_cast<double>(quantity.literal.flops()) /
                   static_cast<double>(std::max<std::size_t>(1, quantity.run.flops())),
               name_of(quantity.tracing), quantity.evaluation ? name_of(*quantity.evaluation) : "-");
  }
  fmt::print("\nForward dynamics: {}\n  instead of {}.\n\nWhy:\n", explanation.quantities[0].run.text(),
             explanation.quantities[0].literal.text());
  for (const auto& reason : explanation.reasons) fmt::print("- {}\n", reason);
}

int run(const ExplainLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const auto scene = std::make_shared<const Scene>(load_scene(options.scene, options.overrides()));
  const Explanation explanation = explain(scene);
  if (options.json)
    print_json(as_json(explanation));
  else
    print_table(explanation);
  return 0;
}

}  // namespace

void add_explain_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ExplainLine>();
  command.add_option("scene", options->scene, "the scene file")->required()->type_name("SCENE");
  add_common_options(command, *options);
  command.footer("Example:\n  mixloop explain scenes/mixed_loop_robot.yaml");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
