// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>
#include <map>
#include <vector>

#include "dynamics/symbolic/harmonic_energy.hpp"

namespace mixloop {

/// A real function sum Re(w exp(i key . theta)) x^powers, its keys one of each pair of opposites.
using WaveSum = std::map<HarmonicKey, std::complex<DoubleDouble>>;

/// A part f(theta) A of the mass matrix within one block, A constant.
struct WaveGroup {
  std::size_t block = 0;
  Eigen::MatrixXd A;  ///< of the block's size
  WaveSum f;
};

/// The energy in a basis of rates y = B psid in which the mass matrix falls into blocks:
/// N = N_0 + sum_g A_g f_g(theta).
struct BlockForm {
  Eigen::MatrixXd B, B_inverse;
  std::vector<std::vector<int>> blocks;
  std::map<HarmonicKey, Eigen::MatrixXd> constant;  ///< N_0, by powers of parameters
  std::vector<WaveGroup> groups;
  WaveSum potential;
};

/// The energy in the basis given by rows B.
BlockForm block_form(const HarmonicEnergy& energy, const Eigen::MatrixXd& B);

/// Bases made of joint and absolute angle rates, those with the sparsest mass matrix first.
std::vector<Eigen::MatrixXd> candidate_bases(const HarmonicEnergy& energy, std::size_t most);

/// The function that a harmonic sum is.
WaveSum waves_of(const HarmonicSum& sum);

}  // namespace mixloop
