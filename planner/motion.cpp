// SPDX-License-Identifier: MIT
#include "planner/motion.hpp"

namespace mixloop {
namespace {

/// The first elements are `x`'s.
void complete(Vector& x, const Vector& otherwise) {
  const Eigen::Index n = otherwise.size(), known = x.size();
  x.conservativeResize(n);
  x.tail(n - known) = otherwise.tail(n - known);
}

}  // namespace

PsiMotion with_free_at_home(const Scene& scene, PsiMotion motors) {
  complete(motors.psi, map_of(std::span(scene.home)));
  for (Vector* rates : {&motors.psid, &motors.psidd}) complete(*rates, Vector::Zero(scene.n()));
  return motors;
}

}  // namespace mixloop
