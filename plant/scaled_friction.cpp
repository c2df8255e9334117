// SPDX-License-Identifier: MIT
#include "plant/scaled_friction.hpp"

#include <algorithm>

#include "dynamics/scene/canonical.hpp"

namespace mixloop {
namespace {

std::shared_ptr<const Scene> without_damping(const Scene& scene) {
  auto undamped = std::make_shared<Scene>(scene);
  for (auto& load : undamped->coordinate_loads) load.damping = constant_formula(0, load.damping.dimension);
  undamped->canonical = canonical_text(*undamped);
  return undamped;
}

Dynamics undamped_dynamics(const Scene& scene, std::span<const double> parameters, Evaluation how,
                           bool linearises) {
  const auto undamped = without_damping(scene);
  return linearises ? Dynamics(undamped, parameters, how, {Purpose::forward_dynamics, Purpose::linearisation})
                    : Dynamics(undamped, parameters, how, {Purpose::forward_dynamics});
}

/// x(f) = x(0) + f (x(1) - x(0))
void mix(std::span<const double> without, double factor, std::span<double> with) {
  for (std::size_t i = 0; i < with.size(); ++i) with[i] = without[i] + factor * (with[i] - without[i]);
}

}  // namespace

bool has_damping(const Scene& scene) {
  return std::any_of(scene.coordinate_loads.begin(), scene.coordinate_loads.end(),
                     [](const auto& load) { return !load.damping.is_zero(); });
}

ScaledFriction::ScaledFriction(const Scene& scene, std::span<const double> parameters, Evaluation how,
                               bool linearises)
    : undamped_(undamped_dynamics(scene, parameters, how, linearises)),
      psidd_(scene.independent.size()),
      slopes_(psidd_.size() * (2 * psidd_.size() + scene.motors().size())) {}

void ScaledFriction::scale(std::span<const double> psi, std::span<const double> psid,
                           std::span<const double> tau, double t, double factor, std::span<double> psidd) {
  undamped_.forward_dynamics(psi, psid, tau, t, psidd_);
  mix(psidd_, factor, psidd);
}

void ScaledFriction::scale_slopes(std::span<const double> psi, std::span<const double> psid,
                                  std::span<const double> tau, double t, double factor,
                                  std::span<double> slopes) {
  undamped_.linearisation(psi, psid, tau, t, slopes_);
  mix(slopes_, factor, slopes);
}

}  // namespace mixloop
