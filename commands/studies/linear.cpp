// SPDX-License-Identifier: MIT
#include "commands/studies/linear.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>

#include "commands/shared/numbers.hpp"
#include "dynamics/procedure/decompositions.hpp"
#include "loop/result.hpp"
#include "notation/value.hpp"
#include "notation/words.hpp"
#include "stability/regulator.hpp"

namespace mixloop {
namespace {

/// Where the law keeps the plant at the start, or where the options say, at rest unless they say otherwise.
PsiMotion motion_of(const LinearLine& line, const Experiment& experiment, const Plan& plan) {
  const Scene& scene = *experiment.scene;
  PsiMotion at = wanted_state(experiment.controller, scene, plan.at(plan.start_tick()));
  const std::span all(scene.independent);
  if (line.psi.empty() && line.psid.empty()) return at;
  const auto taken = [&](const std::string& text, const char* option, const Quantity& quantity) {
    const auto values = values_of(text, option, all, quantity);
    return Vector(map_of(std::span(values)));
  };
  if (!line.psi.empty()) at.psi = taken(line.psi, "--psi", kPosition);
  at.psid = taken(line.psid, "--psid", kVelocity);
  at.psidd.setZero();
  return at;
}

double time_of(const LinearLine& line, const Experiment& experiment, const Plan& plan) {
  if (line.t.empty()) return static_cast<double>(plan.start_tick()) / experiment.rate_hz;
  return number_of(*parse_document(line.t, "--t"), kTime, "--t");
}

/// A weight a number, or one for all.
Vector weights(const std::vector<double>& given, Eigen::Index size, const char* option, double least) {
  const bool one = given.size() == 1;
  if (!one && static_cast<Eigen::Index>(given.size()) != size)
    throw InputError("wrong_size", {option},
                     fmt::format("{} weights; expected one for all, or {}", given.size(), size));
  for (const double weight : given)
    if (!(weight >= least && std::isfinite(weight)))
      throw InputError("out_of_range", {option},
                       fmt::format("a weight of {:g}; expected {} or more", weight, least));
  if (one) return Vector::Constant(size, given.front());
  return map_of(std::span(given));
}

Matrix regulator(const LinearLine& line, const LinearPlant& plant, const Held& held) {
  const Vector state = weights(line.state_weights, plant.A.rows(), "--regulator", 0);
  const Vector torque = line.torque_weights.empty()
                            ? Vector(Vector::Ones(plant.B.cols()))
                            : weights(line.torque_weights, plant.B.cols(), "--torque-weights", 1e-300);
  const auto gain = regulator_gain(held, state, torque);
  if (!gain)
    throw RunFault("no_regulator",
                   "no gain makes the loop stable with these weights here: the motors don't reach what moves "
                   "away, or no weight sees it; expected other weights or another pose");
  return *gain;
}

nlohmann::json as_json(const Experiment& experiment, const LinearPlant& plant, const Held& held) {
  const Scene& scene = *experiment.scene;
  nlohmann::json json = {{"experiment", experiment.name},
                         {"coordinates", nlohmann::json::array()},
                         {"n_motors", scene.n_u()},
                         {"t", plant.t},
                         {"psi", list(plant.at.psi)},
                         {"psid", list(plant.at.psid)},
                         {"psidd", list(plant.at.psidd)},
                         {"torque", list(plant.torque)},
                         {"A", rows(plant.A)},
                         {"B", rows(plant.B)},
                         {"tick", 1 / experiment.rate_hz},
                         {"Phi", rows(held.Phi)},
                         {"Gamma", rows(held.Gamma)},
                         {"poles", nlohmann::json::array()}};
  for (const auto& coordinate : scene.independent) json["coordinates"].push_back(coordinate.name);
  if (plant.free_torque.size() > 0) json["free_torque"] = list(plant.free_torque);
  for (const auto& pole : eigenvalues(plant.A)) json["poles"].push_back({pole.real(), pole.imag()});
  return json;
}

/// That free coordinates don't stay there.
std::string moves_on(const Scene& scene, const LinearPlant& plant) {
  const double size = 1e-9 * (1 + plant.torque.cwiseAbs().maxCoeff());
  std::vector<std::string> missing;
  for (Eigen::Index i = 0; i < plant.free_torque.size(); ++i) {
    const auto& coordinate = scene.independent[static_cast<std::size_t>(scene.n_u() + i)];
    if (std::abs(plant.free_torque[i]) > size)
      missing.push_back(fmt::format("{:.6g} {} at '{}'", plant.free_torque[i], torque_unit(coordinate.linear),
                                    coordinate.name));
  }
  if (missing.empty()) return {};
  return fmt::format("the free coordinates don't stay so: that would take {}", joined(missing));
}

}  // namespace

void add_linear_options(CLI::App& command, LinearLine& line) {
  auto* linear = command.add_flag(
      "--linear", line.asked, "print x' = A x + B u of the plant alone, and of a tick with the torque held");
  const auto text = [&](const char* name, std::string& to, const char* what, const char* type) {
    command.add_option(name, to, what)->needs(linear)->type_name(type);
  };
  text("--psi", line.psi,
       "of --linear: where, rad or m, all independent coordinates (where the law keeps them at "
       "the start)",
       "A,B,...");
  text("--psid", line.psid, "of --linear: how fast, rad/s or m/s (0 where --psi is given)", "A,B,...");
  text("--t", line.t, "of --linear: when, s", "TIME");
  const auto numbers = [&](const char* name, std::vector<double>& to, const char* what) {
    return command.add_option(name, to, what)->delimiter(',')->type_name("Q,R,...");
  };
  auto* regulator =
      numbers("--regulator", line.state_weights,
              "of --linear: the gain of state_feedback that makes sum x'Qx + u'Ru least, by these "
              "weights of psi, then of psi', SI");
  regulator->needs(linear);
  numbers("--torque-weights", line.torque_weights, "of --regulator: the weights of the motors' torques (1)")
      ->needs(regulator);
}

int tell_linear(const LinearLine& line, const std::string& file, const CommonOptions& options) {
  const Experiment experiment = load_experiment(std::filesystem::path(file), options.overrides());
  const Plan plan = make_plan(experiment);
  Linearisation linearisation(experiment);
  say_complaint(linearisation.equations().complaint());
  const LinearPlant plant =
      linearisation.plant_at(motion_of(line, experiment, plan), time_of(line, experiment, plan));
  const Held held(plant.A, plant.B, 1 / experiment.rate_hz);
  nlohmann::json json = as_json(experiment, plant, held);
  if (!line.state_weights.empty()) json["gain"] = rows(regulator(line, plant, held));
  const std::string warning = moves_on(*experiment.scene, plant);
  json["warnings"] = warning.empty() ? nlohmann::json::array() : nlohmann::json::array({warning});
  if (options.json) {
    print_json(json);
    return kHeld;
  }
  json.erase("warnings");
  if (!warning.empty()) fmt::print(stderr, "warning: {}\n", warning);
  print_lines(json);
  return kHeld;
}

}  // namespace mixloop
