// SPDX-License-Identifier: MIT
// The mass matrix of a mechanism of one's own: two rods of 1 m in a plane, 1 kg at the end of each.
// Stretched out, M = [5 2; 2 1] kg m^2.
#include <cstdio>
#include <mixloop/equations.hpp>

constexpr const char* kTwoRods = R"(
motors: [shoulder, elbow]
coordinates: [q1, q2]
constraints: {q1: shoulder, q2: elbow}
transforms:
  - {from: 0, to: upper, theta: q1, a: 1 m}
  - {from: upper, to: lower, theta: q2, a: 1 m}
bodies:
  - {frame: upper, mass: 1 kg}
  - {frame: lower, mass: 1 kg}
gravity: [0, -9.81 m/s^2, 0]
end_effector: {frame: lower, axes: [x, y]}
)";

int main() try {
  const auto scene = mixloop::Scene::parse(kTwoRods, "two rods");
  mixloop::Equations equations(scene, {mixloop::Purpose::mass_matrix});
  const double psi[] = {0, 0};
  double M[4];
  equations.evaluate(mixloop::Purpose::mass_matrix, {.psi = psi, .psid = {}}, {}, M);
  std::printf("M = [%g %g; %g %g]\n", M[0], M[2], M[1], M[3]);  // column by column
  return M[0] == 5 && M[1] == 2 && M[2] == 2 && M[3] == 1 ? 0 : 1;
} catch (const mixloop::Error& error) {
  std::fprintf(stderr, "%s (%s)\n", error.what(), error.code().c_str());
  return 2;
}
