// SPDX-License-Identifier: MIT
// How programs are held against the procedure in 113-bit floats.
#pragma once

#include <memory>
#include <random>
#include <span>
#include <vector>

#include "dynamics/procedure/purpose.hpp"
#include "dynamics/program/routine.hpp"
#include "tests/oracles/in_wide.hpp"

namespace mixloop::testing {

/// A state and an input, seeded.
struct Sample {
  std::vector<double> psi, psid, input;
  double t = 0.0;

  Arguments arguments() const { return {psi, psid, input, t}; }
};

inline Sample random_sample(const Scene& scene, std::mt19937_64& random, double angle = 10.0) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Sample sample;
  const auto fill = [&](std::vector<double>& x, int size, double scale) {
    for (int i = 0; i < size; ++i) x.push_back(scale * unit(random));
  };
  for (const auto& psi : scene.independent) sample.psi.push_back((psi.linear ? 0.5 : angle) * unit(random));
  fill(sample.psid, scene.n(), 3.0);
  fill(sample.input, 2 * scene.n(), 5.0);
  sample.t = unit(random);
  return sample;
}

/// What the outputs are, in 113 bits, and the size that round-off in doubles is measured against: that of
/// the largest term that goes into an output.
struct Oracle {
  std::vector<Wide> value;
  std::vector<double> scale;
};

Oracle oracle(const std::shared_ptr<const Scene>& scene, std::span<const double> parameters, Purpose purpose,
              const Sample& sample);

/// The largest error of the outputs, in units in the last place of their scale.
double error_in_ulps(const Oracle& oracle, std::span<const double> outputs);

}  // namespace mixloop::testing
