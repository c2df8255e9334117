// SPDX-License-Identifier: MIT
#include "loop/measured.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

bool are_alike(const Scene::Independent& a, const Scene::Independent& b) {
  return a.name == b.name && a.linear == b.linear && a.driven == b.driven;
}

std::string described(std::span<const Scene::Independent> coordinates) {
  std::string text;
  for (const auto& coordinate : coordinates)
    text += fmt::format("{}{}{}{}", text.empty() ? "" : ", ", coordinate.name,
                        coordinate.linear ? " (linear)" : "", coordinate.driven ? "" : " (free)");
  return text;
}

/// The first coordinate that isn't measured where `takes(i)` says that the law does; -1 where there is none.
int unseen(const std::vector<int>& seen, const std::function<bool(std::size_t)>& takes) {
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] < 0 && takes(i)) return static_cast<int>(i);
  return -1;
}

}  // namespace

std::vector<int> measured_coordinates(const Experiment& experiment) {
  return experiment.plant.sensors.measured(experiment.scene->independent.size());
}

std::vector<int> model_coordinates(const Experiment& experiment) {
  const auto& plants = experiment.scene->independent;
  std::vector<int> places;
  for (const auto& one : experiment.controller_scene->independent)
    places.push_back(static_cast<int>(
        std::ranges::find_if(plants, [&](const auto& other) { return are_alike(one, other); }) -
        plants.begin()));
  return places;
}

std::vector<int> seen_coordinates(const Experiment& experiment) {
  const std::vector<int> measured = measured_coordinates(experiment);
  std::vector<int> seen;
  const auto see = [&](int coordinate) {
    const auto at = std::ranges::find(measured, coordinate);
    seen.push_back(at == measured.end() ? -1 : static_cast<int>(at - measured.begin()));
  };
  if (experiment.controller.law == Law::state_feedback)
    for (int i = 0; i < experiment.scene->n(); ++i) see(i);
  else
    for (const int i : model_coordinates(experiment)) see(i);
  return seen;
}

void require_same_motors(const Scene& controllers, const Scene& plants, const Place& place) {
  const bool same_motors = std::ranges::equal(controllers.motors(), plants.motors(), are_alike);
  const bool has_all = std::ranges::all_of(controllers.independent, [&](const auto& one) {
    return std::ranges::any_of(plants.independent, [&](const auto& other) { return are_alike(one, other); });
  });
  if (same_motors && has_all) return;
  const bool as_many = controllers.n() == plants.n() && controllers.n_u() == plants.n_u();
  throw InputError(
      as_many ? "other_motors" : "wrong_size", place,
      fmt::format("the controller's scene has the motors {}, the plant's {}; expected the same names, "
                  "kinds and order, and no other free coordinates than the plant's",
                  described(controllers.independent), described(plants.independent)));
}

void require_measured(const Experiment& experiment, const NodePtr& controller) {
  const ControllerSettings& settings = experiment.controller;
  const std::vector<int> seen = seen_coordinates(experiment);
  const auto refuse = [&](const char* key, const Scene& scene, int coordinate, const std::string& how) {
    throw InputError(
        "not_measured", find_entry(*controller, key)->place,
        fmt::format("{} the free coordinate {}, which isn't measured (plant.sensors.free); expected {}", how,
                    in_quotes(scene.independent[static_cast<std::size_t>(coordinate)].name),
                    settings.law == Law::state_feedback
                        ? "zeros in its columns, or it among those measured"
                        : "it among those measured, or a controller.scene without it"));
  };
  if (settings.law == Law::state_feedback) {
    const Eigen::Index n = settings.about_psi.size();
    const int column = unseen(seen, [&](std::size_t i) {
      const auto j = static_cast<Eigen::Index>(i);
      return !settings.gain.col(j).isZero(0) || !settings.gain.col(n + j).isZero(0);
    });
    if (column >= 0) refuse("gain", *experiment.scene, column, "the gain feeds back");
  } else if (has_gains(settings.law) && settings.law != Law::pd) {
    const int missing = unseen(seen, [](std::size_t) { return true; });
    if (missing >= 0)
      refuse("law", *experiment.controller_scene, missing,
             fmt::format("the law {} takes its model where it stands by",
                         describe(*find_entry(*controller, "law"))));
  }
}

}  // namespace mixloop
