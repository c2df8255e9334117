// SPDX-License-Identifier: MIT
#pragma once

#include <mixloop/mixloop.hpp>

#include <algorithm>

#include "dynamics/equations.hpp"
#include "loop/experiment.hpp"
#include "notation/errors.hpp"
#include "notation/long_work.hpp"

namespace mixloop::v1 {

struct Scene::Content {
  std::shared_ptr<const mixloop::Scene> scene;
};
struct Experiment::Content {
  mixloop::Experiment experiment;
};
struct Plan::Content {
  mixloop::Plan plan;
};

struct Inside {
  static Scene of(std::shared_ptr<const mixloop::Scene> scene) {
    return Scene(std::make_shared<const Scene::Content>(Scene::Content{std::move(scene)}));
  }
  static Experiment of(mixloop::Experiment experiment) {
    return Experiment(
        std::make_shared<const Experiment::Content>(Experiment::Content{std::move(experiment)}));
  }
  static const std::shared_ptr<const mixloop::Scene>& of(const Scene& scene) { return scene.content_->scene; }
  static const mixloop::Experiment& of(const Experiment& experiment) {
    return experiment.content_->experiment;
  }
  static const mixloop::Plan& of(const Plan& plan) { return plan.content_->plan; }
};

}  // namespace mixloop::v1

namespace mixloop::inside {

/// What a call gives; what our rooms throw comes out as the library's Error, all else as it is.
template <class Call>
auto translated(const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const InputError& bad) {
    throw v1::Error(bad.code, {bad.place.file, bad.place.line, bad.place.column}, bad.message);
  } catch (const RunFault& fault) {
    throw v1::Error(fault.code, {}, fault.what());
  } catch (const Interrupted& interrupted) {
    throw v1::Error("interrupted", {}, interrupted.what());
  }
}

inline std::vector<Override> overrides(const std::vector<std::string>& sets) {
  std::vector<Override> result;
  for (const std::string& set : sets) result.push_back(parse_override(set));
  return result;
}

/// Throws Error("wrong_size") unless there are as many numbers.
void require_size(const char* what, std::size_t found, std::size_t expected);

inline v1::Reference seen(const Reference& r) {
  const auto three = [](const Reference::Triple& at) { return std::span<const double, 3>(at.data(), 3); };
  const auto all = [](const Reference::Values& at) {
    return std::span<const double>(at.data(), static_cast<std::size_t>(at.size()));
  };
  return {all(r.psi), all(r.psid), all(r.psidd), three(r.position), three(r.velocity), three(r.acceleration)};
}

inline Reference meant(const v1::Reference& r) {
  const auto all = [](std::span<const double> at) {
    return Reference::Values(at.data(), static_cast<Eigen::Index>(at.size()));
  };
  return {all(r.psi),
          all(r.psid),
          all(r.psidd),
          Reference::Triple(r.position.data()),
          Reference::Triple(r.velocity.data()),
          Reference::Triple(r.acceleration.data())};
}

}  // namespace mixloop::inside
