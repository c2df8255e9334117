// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// Torques that depend on the time alone: formulas of it, or samples that are held.
class TorqueCourse {
 public:
  /// `[0.2 N m, 1 N * sin(2 pi rad/s * t)]`, one formula of t for each motor, a torque or a force as the
  /// motor is. Throws InputError as formulas do, "wrong_size" for another number of them.
  static TorqueCourse of_formulas(const NodePtr& node, const Scene& scene);

  /// A CSV file, its path counted from `folder`: a row a sample, t in s and the motors' torques in SI; a
  /// first line that begins with `t` names the columns; empty lines and those that begin with # are left out.
  /// Throws InputError: "no_such_file" at the node; "invalid_table", with line and column in the file, for
  /// what is no finite number, for too few or too many in a row, for times that don't ascend, or don't begin
  /// at 0 s or before.
  static TorqueCourse of_file(const Node& node, const std::filesystem::path& folder, const Scene& scene);

  /// What acts at t (s, 0 or later), n_u: of samples the latest one that isn't after t, so the last one
  /// stays. Allocates nothing.
  void at(double t, std::span<double> tau) const;

 private:
  std::vector<Formula> formulas_;
  std::vector<double> times_, samples_;  ///< s; n_u each
};

}  // namespace mixloop
