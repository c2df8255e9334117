// SPDX-License-Identifier: MIT
// Linkages of scenes/, written from their publications or drawings, not from the scenes.
#pragma once

#include <cstdlib>
#include <type_traits>

#include "tests/oracles/planar_linkage.hpp"

namespace mixloop::oracle {

/// A decimal number, as near as T has it.
template <class T>
T decimal(const char* text) {
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<T>(std::strtold(text, nullptr));
  else
    return T(text);
}

/// Andrews' squeezing mechanism, angles (beta, Theta, gamma, Phi, delta, Omega, epsilon): the centres, loops
/// and numbers of Hairer & Wanner, Solving ODEs II, VII.7, and of the test set for initial value problems.
/// Its torque, on beta, is 0.033 N m.
template <class T>
Linkage<T> seven_bodies() {
  const auto num = [](const char* text) { return decimal<T>(text); };
  const T xa = num("-0.06934"), ya = num("-0.00227"), xb = num("-0.03635"), yb = num("0.03273"),
          d = num("0.028"), da = num("0.0115"), e = num("0.02"), ea = num("0.01421"), rr = num("0.007"),
          ra = num("0.00092"), ss = num("0.035"), sa = num("0.01874"), sb = num("0.01043"), sc = num("0.018"),
          sd = num("0.02"), ta = num("0.02308"), tb = num("0.00916"), u = num("0.04"), ua = num("0.01228"),
          ub = num("0.00449"), zf = num("0.02"), zt = num("0.04"), fa = num("0.01421");
  const std::vector<int> beta{1}, Theta{1, 1}, gamma{0, 0, 1}, Phi{0, 0, 0, 1, 1}, delta{0, 0, 0, 0, 1},
      Omega{0, 0, 0, 0, 0, 1, 1}, epsilon{0, 0, 0, 0, 0, 0, 1};
  // (a sin x + b cos x, -a cos x + b sin x) is (b, -a) turned by x.
  Linkage<T> linkage{.angles = 7};
  linkage.bodies = {
      {num("0.04325"), num("2.194e-6"), beta, {0, 0, {{beta, ra, 0}}}},
      {num("0.00365"), num("4.410e-7"), Theta, {0, 0, {{beta, rr, 0}, {Theta, -da, 0}}}},
      {num("0.02373"), num("5.255e-6"), gamma, {xb, yb, {{gamma, sb, -sa}}}},
      {num("0.00706"), num("5.667e-7"), Phi, {xa, ya, {{delta, zt, 0}, {Phi, 0, ea - e}}}},
      {num("0.07050"), num("1.169e-5"), delta, {xa, ya, {{delta, ta, tb}}}},
      {num("0.00706"), num("5.667e-7"), Omega, {xa, ya, {{epsilon, 0, -u}, {Omega, zf - fa, 0}}}},
      {num("0.05498"), num("1.912e-5"), epsilon, {xa, ya, {{epsilon, -ub, -ua}}}}};
  linkage.loops = {{-xb, -yb, {{beta, rr, 0}, {Theta, -d, 0}, {gamma, 0, ss}}},
                   {-xa, -ya, {{beta, rr, 0}, {Theta, -d, 0}, {Phi, 0, e}, {delta, -zt, 0}}},
                   {-xa, -ya, {{beta, rr, 0}, {Theta, -d, 0}, {Omega, -zf, 0}, {epsilon, 0, u}}}};
  linkage.springs = {{{xb, yb, {{gamma, sd, -sc}}}, num("0.014"), num("0.072"), num("4530"), num("0.07785")}};
  return linkage;
}

/// Angles at the start of the publications' motion, at rest.
template <class T>
LinkageVector<T> seven_bodies_start() {
  LinkageVector<T> q(7);
  q << decimal<T>("-0.0617138900142764496"), T(0), decimal<T>("0.455279819163070380"),
      decimal<T>("0.222668390165885884"), decimal<T>("0.487364979543842550"),
      decimal<T>("-0.222668390165885884"), decimal<T>("1.230547444549821192");
  return q;
}

/// scenes/four_bar.yaml, angles: the crank's, the coupler's from the crank on, the rocker's.
template <class T>
Linkage<T> four_bar_linkage() {
  const auto num = [](const char* text) { return decimal<T>(text); };
  const std::vector<int> crank{1}, coupler{1, 1}, rocker{0, 0, 1};
  Linkage<T> linkage{.angles = 3, .gravity = num("9.81")};
  linkage.bodies = {
      {num("1"), num("0.01"), crank, {0, 0, {{crank, num("0.15"), 0}}}},
      {num("2"), num("0.05"), coupler, {0, 0, {{crank, num("0.3"), 0}, {coupler, num("0.45"), 0}}}},
      {num("1.5"), num("0.04"), rocker, {1, 0, {{rocker, num("0.4"), 0}}}}};
  linkage.loops = {{-1, 0, {{crank, num("0.3"), 0}, {coupler, num("0.9"), 0}, {rocker, num("-0.8"), 0}}}};
  return linkage;
}

}  // namespace mixloop::oracle
