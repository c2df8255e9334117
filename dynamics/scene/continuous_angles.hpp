// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// An arc tangent, in a constraint or in what a load acts along, that may jump where the mechanism doesn't:
/// an atan2 whose value counts, not only its sine and cosine (a load reads the coordinate, a slide moves by
/// it, or it is taken times what is no whole number), by a turn at its cut; an atan of a quotient by half a
/// turn where the divisor passes zero.
struct CountedAngle {
  int coordinate = 0;  ///< that the constraint gives
  int load = -1;       ///< or where it stands in what a load acts along: its number among along_loads
  int node = 0;        ///< of that formula
  bool of_quotient = false;
};
std::vector<CountedAngle> counted_angles(const Scene& scene);

/// Writes each atan2 of them as h + atan2 of what is turned back by h, its value at home for the default
/// parameters: its cut, where it jumps, lies half a turn away from home, and an angle that starts at 170 deg
/// goes on through 180.
void turn_cuts_away_from_home(Scene& scene);

/// Looks at these angles again and again along a motion.
class AngleWatch {
 public:
  AngleWatch(const Scene& scene, std::vector<double> parameters);

  bool needed() const { return !angles_.empty(); }
  /// Which coordinate jumped since the last look, and why; empty where none did, and at the first look.
  std::string look(std::span<const double> psi, double t);

 private:
  const Scene& scene_;
  std::vector<CountedAngle> angles_;
  std::vector<double> symbols_, last_;
};

}  // namespace mixloop
