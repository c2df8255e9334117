// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/evaluator.hpp"
#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

bool has_damping(const Scene& scene);

/// Forward dynamics with a scene's viscous friction times a factor. psi'' is affine in the damping, so
///   psi''(f) = psi''(0) + f (psi''(1) - psi''(0))
/// with psi''(0) of the same scene without any. An evaluation costs a second one; nothing allocates after
/// construction.
class ScaledFriction {
 public:
  /// `linearises`: the slopes are asked for too.
  ScaledFriction(const Scene& scene, std::span<const double> parameters, Evaluation how, bool linearises);

  void set_parameters(std::span<const double> parameters) { undamped_.set_parameters(parameters); }
  /// Makes psi''(factor) of psi''(1).
  void scale(std::span<const double> psi, std::span<const double> psid, std::span<const double> tau, double t,
             double factor, std::span<double> psidd);
  /// The same of Dynamics::linearisation.
  void scale_slopes(std::span<const double> psi, std::span<const double> psid, std::span<const double> tau,
                    double t, double factor, std::span<double> slopes);

 private:
  Dynamics undamped_;
  std::vector<double> psidd_, slopes_;
};

}  // namespace mixloop
