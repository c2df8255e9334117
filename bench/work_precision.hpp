// SPDX-License-Identifier: MIT
// Error against CPU time: what is integrated, and a point of a curve (docs/accuracy.md).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace mixloop::bench {

/// A motion with a known end: ticks with the torque held, by a controller or from a table, or control
/// evaluated continuously.
struct Case {
  enum class Drive { closed_loop, continuous, table };
  std::string name, title;
  Drive drive = Drive::table;
  Experiment experiment;  ///< of a closed loop; else only its scene, parameters and rate count
  std::vector<double> psi0, psid0;
  int ticks = 1000, sample_every = 20;
  bool papers_robot = true;                                    ///< the peers have a model of it
  std::function<void(int k, std::span<double> tau)> torque{};  ///< of tick k, where there is no controller
  bool smooth = false;              ///< its torque never jumps: a solver may go on from tick to tick
  int converged_steps[2] = {2, 1};  ///< of DOP853 and Gauss of order 12 a tick, in 113 bits
  bool by_multipliers = false;      ///< converged by the equations of tests/oracles, of all seven angles
  std::shared_ptr<const Scene> closed{};  ///< the same mechanism, told by its closures

  int n() const { return experiment.scene->n(); }
  double tick() const { return 1 / experiment.rate_hz; }
};

std::vector<Case> all_cases();

/// psi and psi' (2n numbers) after each `sample_every` ticks.
using Samples = std::vector<std::vector<double>>;

/// The converged samples, from bench/converged/NAME.txt; throws std::runtime_error where they are missing.
Samples converged_samples(const Case& problem);
/// Works them out in 113 bits by two methods and writes the file; says on how many digits they agree.
void converge(const Case& problem);

/// The largest difference of a number from the converged one, as a share of the largest size that it has over
/// the samples; not finite where a run broke down.
double error_of(const Samples& samples, const Samples& converged);

struct Point {
  std::string problem, curve, setting;
  double error = 0;
  double cpu = 0;  ///< s, the least of several runs
};

/// Forward dynamics of the peers and their tick loops; each calls `keep` with a point.
using Keep = std::function<void(const std::string& curve, const std::string& setting,
                                const std::function<Samples()>&)>;
void sundials_points(const Case& problem, const Keep& keep);
void peer_points(const Case& problem, const Keep& keep);

}  // namespace mixloop::bench
