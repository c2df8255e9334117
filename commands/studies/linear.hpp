// SPDX-License-Identifier: MIT
#pragma once

#include "processes/command_line.hpp"

namespace mixloop {

/// `mixloop stability --linear`: where a plant is linearised, and what a regulator is to weigh.
struct LinearLine {
  bool asked = false;
  std::string psi, psid, t;                           ///< empty: where the law keeps it at the start
  std::vector<double> state_weights, torque_weights;  ///< of --regulator; 2n and n_u, one for all or none
};

void add_linear_options(CLI::App& command, LinearLine& line);

/// Tells A and B there; the exit status.
int tell_linear(const LinearLine& line, const std::string& experiment, const CommonOptions& options);

}  // namespace mixloop
