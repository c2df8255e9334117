// SPDX-License-Identifier: MIT
// The shipped mechanisms whose chains close, as places of masses in closed form: circles cut by vectors, and
// Bennett's relation between the angles of his linkage. w is the platform's pose, or the driven angle.
#pragma once

#include <numbers>

#include "tests/oracles/point_masses.hpp"

namespace mixloop::oracle {

inline Jet3 in_plane(const Jet& angle) { return {cos(angle), sin(angle), 0}; }

/// Where circles of radii r about `from` and R about `to` meet, left of the line from one to the other.
inline Jet3 left_crossing(const Jet3& from, const Jet& r, const Jet3& to, const Jet& R) {
  const Jet3 line = to - from;
  const Jet square = dot(line, line), along = (r * r - R * R + square) / (2 * square);
  const Jet across = sqrt(r * r / square - along * along);
  return from + line * along + Jet3{-line[1], line[0], 0} * across;
}

/// scenes/planar_3rrr.yaml; w = x, y, turn of its platform.
inline Masses planar_3rrr(const std::vector<Jet>& w) {
  constexpr double base = 0.5, corner = 0.12, crank = 0.25, rod = 0.35;
  Masses masses;
  const Jet3 middle{w[0], w[1], 0};
  for (const double degrees : {-150, -30, 90}) {
    const double angle = degrees * std::numbers::pi / 180;
    const Jet3 A = in_plane(angle) * base, C = middle + in_plane(w[2] + angle) * corner;
    const Jet3 B = left_crossing(A, crank, C, rod);
    masses.motors.push_back(atan2(B[1] - A[1], B[0] - A[0]));
    masses.add_bar(2 * crank, A, B);
    masses.add_bar(2 * rod, B, C);
  }
  masses.add(1.2, middle, {in_plane(w[2]), in_plane(w[2] + std::numbers::pi / 2), Jet3{0, 0, 1}},
             {0.004, 0.004, 0.008});
  return masses;
}

/// scenes/delta_robot.yaml with this payload, kg; w = x, y, z of its platform.
inline Masses delta_robot(const std::vector<Jet>& w, double payload = 0.5) {
  constexpr double base = 0.16, corner = 0.04, arm = 0.2, rod = 0.45, rods_mass = 0.12;
  Masses masses;
  for (const double turn : {0, 120, 240}) {
    const double angle = turn * std::numbers::pi / 180;
    const Jet3 outward = in_plane(angle), across = in_plane(angle + std::numbers::pi / 2);
    const Jet3 A = outward * base, C = Jet3{w[0], w[1], w[2]} + outward * corner;
    // In the arm's plane: outward and up. What a rod reaches across it leaves less of its length there.
    const Jet beside = dot(C - A, across);
    const Jet3 in_arm{dot(C - A, outward), w[2], 0};
    const Jet3 end = left_crossing({0, 0, 0}, arm, in_arm, sqrt(rod * rod - beside * beside));
    const Jet3 B = A + outward * end[0] + Jet3{0, 0, 1} * end[1];
    masses.motors.push_back(atan2(-end[1], end[0]));
    masses.add_bar(0.3, A, B);
    masses.add(rods_mass / 2, B);
  }
  masses.add(0.2 + 3 * rods_mass / 2 + payload, {w[0], w[1], w[2]});
  return masses;
}

/// The turns of scenes/spatial_five_bar.yaml's joints. Bennett's linkage with bars a, b has
///   tan(A/2) tan(B/2) = sin((alpha + beta)/2) / sin((alpha - beta)/2), opposite angles opposite;
/// Goldberg's five-bar is two of them that share a bar, which is left out.
inline std::array<Jet, 4> five_bar_turns(const Jet& crank, double alpha, double beta, double gamma) {
  const auto opposite = [&](const Jet& angle, double twist) {
    const double k = std::sin((alpha + twist) / 2) / std::sin((alpha - twist) / 2);
    return 2 * atan2(k * cos(angle * 0.5), sin(angle * 0.5));
  };
  const Jet shared = std::numbers::pi - opposite(crank, beta), second = opposite(shared, gamma);
  return {crank, second, -shared, std::numbers::pi - second - crank};
}

/// scenes/spatial_five_bar.yaml; w = its crank's angle.
inline Masses spatial_five_bar(const std::vector<Jet>& w) {
  constexpr double degree = std::numbers::pi / 180, alpha = 60 * degree, beta = 20 * degree,
                   gamma = 15 * degree;
  const double a = 0.4, b = a * std::sin(beta) / std::sin(alpha), c = a * std::sin(gamma) / std::sin(alpha);
  const auto turns = five_bar_turns(w[0], alpha, beta, gamma);
  const std::array<double, 4> length{b + c, a, c, b}, twist{beta + gamma, alpha, gamma, beta},
      mass{1.2, 1, 0.5, 0.7};
  Masses masses;
  masses.motors = {w[0]};
  Jet3 origin{0, 0, 0};
  std::array<Jet3, 3> axes{Jet3{1, 0, 0}, Jet3{0, 1, 0}, Jet3{0, 0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Jet3 x = axes[0] * cos(turns[k]) + axes[1] * sin(turns[k]);
    const Jet3 y = axes[1] * cos(turns[k]) - axes[0] * sin(turns[k]), z = axes[2];
    const Jet3 middle = origin + x * (length[k] / 2);
    origin = origin + x * length[k];
    axes = {x, y * std::cos(twist[k]) + z * std::sin(twist[k]),
            z * std::cos(twist[k]) - y * std::sin(twist[k])};
    const double across = mass[k] * length[k] * length[k] / 12;
    masses.add(mass[k], middle, axes, {0.0002, across, across});
  }
  return masses;
}

/// scenes/four_bar_chain.yaml; w = its motor's angle.
inline Masses four_bar_chain(const std::vector<Jet>& w) {
  constexpr double ground = 1, crank = 0.5, coupler = 1.05, rocker = 0.55;
  Masses masses;
  masses.motors = {w[0]};
  Jet3 pivot{0, 0, 0}, driven = in_plane(w[0]);
  for (int loop = 0; loop < 4; ++loop) {
    const Jet3 A = pivot + driven * crank, next = pivot + Jet3{ground, 0, 0};
    const Jet3 B = left_crossing(A, coupler, next, rocker);
    masses.add_bar(0.5, pivot, A);
    masses.add_bar(1, A, B);
    masses.add_bar(0.5, next, B);
    driven = (B - next) * (1 / rocker);
    pivot = next;
  }
  return masses;
}

}  // namespace mixloop::oracle
