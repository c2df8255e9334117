// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/shared/numbers.hpp"
#include "commands/shared/progress.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "dynamics/procedure/singular_mass.hpp"
#include "loop/experiment.hpp"
#include "notation/value.hpp"
#include "processes/command_line.hpp"

namespace mixloop {
namespace {

struct DynamicsLine : CommonOptions {
  std::string scene, psi, psid, tau;
  std::string t = "0";
};

/// The closures hold on the straight line from home.
void require_closed(Equations::Workspace& watched, std::span<const double> psi, double t) {
  if (watched.closures().accept(psi, t) != Status::ok)
    throw InputError(
        "branch_undecided", {"--psi"},
        "on the straight line from home the closures are not solved up to this pose: it is out of "
        "the mechanism's reach, or beyond a singular pose, where more than one way goes on. "
        "Expected a pose on home's side, or another home");
}

nlohmann::json evaluated(const DynamicsLine& options, const std::shared_ptr<const Scene>& scene) {
  const auto parameters = scene->default_parameters();
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  Workspace<double> ws(model);
  using In = std::span<const double>;
  const std::span all(scene->independent);
  // A mechanism whose chains close stands at home; at zero it may not close.
  const auto psi = options.psi.empty() && scene->is_closed()
                       ? scene->home
                       : values_of(options.psi, "--psi", all, kPosition),
             psid = values_of(options.psid, "--psid", all, kVelocity),
             tau = values_of(options.tau, "--tau", scene->motors(), kTorque);
  const double t = number_of(*parse_document(options.t, "--t"), kTime, "--t");

  Equations::Workspace watched(equations_of(scene, Evaluation::interpreter, {}), parameters);
  if (scene->is_closed()) require_closed(watched, psi, t);
  require_inertia(scene, parameters);
  if (const auto why = why_mass_is_singular(model, psi, t))
    throw InputError("singular_mass", {"--psi"}, "the mass matrix is singular at this pose: " + *why);

  nlohmann::json json;
  const Vector psidd = forward_dynamics<double>(model, In(psi), In(psid), In(tau), t, ws);
  if (!psidd.allFinite())
    throw InputError(
        "not_finite", {"--psi"},
        "the equations of motion are not finite at this pose: a formula has no value there, or the "
        "ends of a spring or damper between points meet, which gives it no direction");
  json["psidd"] = list(psidd);
  json["mass_matrix"] = rows(mass_matrix<double>(model, In(psi), t, ws));
  json["bias"] = list(bias<double>(model, In(psi), In(psid), t, ws));
  json["q"] = list(ws.q);
  json["n_motors"] = scene->n_u();
  json["constraint_jacobian"] = rows(ws.C);
  if (scene->is_closed()) {
    const ClosureWatch watch = watched.closures().watch();
    json["closure_residual"] = watch.residual;
    json["closure_condition"] = std::vector<double>(watch.conditions.begin(), watch.conditions.end());
  }
  if (!scene->end_effector.named) return json;
  const auto& hand = end_effector<double>(model, In(psi), In(psid), span_of(psidd), t, ws);
  json["end_effector"] = {{"position", list(hand.position)},
                          {"velocity", list(hand.velocity)},
                          {"acceleration", list(hand.acceleration)},
                          {"jacobian", rows(hand.jacobian)}};
  return json;
}

int run(const DynamicsLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const auto scene = std::make_shared<const Scene>(load_scene(options.scene, options.overrides()));
  const auto json = evaluated(options, scene);
  if (options.json) {
    print_json(json);
  } else {
    for (const auto& warning : scene->warnings) fmt::print(stderr, "warning: {}\n", warning);
    print_lines(json);
  }
  return 0;
}

}  // namespace

void add_dynamics_command(CLI::App& command, int& status) {
  auto options = std::make_shared<DynamicsLine>();
  command.add_option("scene", options->scene, "the scene file")->required()->type_name("SCENE");
  command
      .add_option("--psi", options->psi,
                  "positions of all independent coordinates, the motors' first, rad or m, e.g. 1,2,3 or "
                  "'57 deg, 0, 10 cm'; zero when omitted, home where chains close")
      ->type_name("A,B,...");
  command.add_option("--psid", options->psid, "their velocities, rad/s or m/s")->type_name("A,B,...");
  command.add_option("--tau", options->tau, "motor torques or forces, N m or N")->type_name("A,B,...");
  command.add_option("--t", options->t, "time, s, for constraints and loads that depend on it")
      ->type_name("TIME");
  add_common_options(command, *options);
  command.footer(
      "Prints Q, C, M, h, psi'' and the end effector in SI, matrices row by row; where chains close, by how "
      "much "
      "they are open and how near to a singular pose.\n"
      "Example:\n"
      "  mixloop dynamics scenes/mixed_loop_robot.yaml --psi 1,2,3 --psid 0.1,0.2,0.3 --set "
      "parameters.payload='3 kg'");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
