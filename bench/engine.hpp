// SPDX-License-Identifier: MIT
// What the forward dynamics benchmark asks of an engine: the paper's robot with 5 kg at the end effector.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace mixloop::bench {

using Triple = std::array<double, 3>;
using Symmetric = std::array<double, 6>;   ///< 11, 12, 13, 22, 23, 33
using MassMatrix = std::array<double, 9>;  ///< begins with a Symmetric, or is all of it

struct State {
  Triple psi{}, psid{}, tau{};
};

inline constexpr double kPayload = 5.0;   // kg
inline constexpr double kGravity = 9.81;  // m/s^2, along -Z0

/// One row of the table. Every evaluation goes through an opaque call, for all engines alike; lanes go
/// through `forward_all` instead. An empty function leaves its column out.
struct Engine {
  std::string name;
  double tolerance = 1e-12;  ///< relative error against the oracle that it must keep
  std::function<void(const State&, Triple& psidd)> forward;
  std::function<void(const State&, MassMatrix& M)> mass;
  bool whole_matrix = false;  ///< it writes all of M, which no caller has to bring into another layout
  std::function<void(const State&, Triple& force)> mass_times;  ///< M a, with a = state.tau
  std::function<void(const State&, Triple& psidd, Triple& force)> forward_and_mass_times;
  std::function<void(const std::vector<State>&, std::vector<Triple>& psidd)> forward_all;
  /// The state after `length` under tau, by the engine's own integrator of order 4 in so many steps.
  std::function<void(State&, double length, int steps)> own_tick;
};

using Engines = std::vector<Engine>;

void add_hand_tuned(Engines& engines);             // products and sums rounded one by one
void add_hand_tuned_contracted(Engines& engines);  // fused where the compiler likes
void add_mixloop(Engines& engines);
void add_textbook(Engines& engines);
void add_mujoco(Engines& engines);
void add_simbody(Engines& engines);

}  // namespace mixloop::bench
