// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planner/motion.hpp"
#include "planner/path.hpp"

namespace mixloop {

/// A duration in ticks; throws InputError("off_grid") when it is no whole number of them (to 1e-9 of itself),
/// "too_large" when it is more than 2^30.
std::int64_t ticks_of(double seconds, double rate_hz, const Place& place, const std::string& what);

/// A path laid on a time grid: lines and rests, each a whole number of steps. Place along it is counted in
/// steps from the path's start, so that step k is reached at exactly k / rate; between steps it is a
/// fraction.
class Itinerary {
 public:
  /// `rate_hz`: the ticks'; `stages`: steps a tick. Throws as ticks_of does, also for a lap of more than 2^30
  /// steps.
  Itinerary(const Path& path, double rate_hz, int stages);

  std::int64_t lap_steps() const { return stretches_.back().first + stretches_.back().count; }
  std::int64_t steps() const { return laps_ * lap_steps(); }
  double step_rate() const { return step_rate_; }

  /// 0 <= step <= steps(). Of a path of the end effector, turned as the points' `rotation` says.
  PathPoint at(double step) const;
  /// The same of a path of the motors.
  PsiMotion motors_at(double step) const;
  /// "0.41 of the line from (0.3, 0, 0.8) to (-0.3, 0.4, 0.3) m, at (0.054, 0.164, 0.595) m", for messages.
  std::string describe(double step) const;
  /// The place, in its file, of the point that the line of this step leads to.
  const Place& place(double step) const;

 private:
  struct Stretch {
    std::int64_t first = 0, count = 0;  ///< steps
    Path::Via from, to;
    Eigen::Vector3d turn;  ///< rotation vector from one to the other, inertial axes
    Place place;
    bool is_rest() const;
  };
  /// A stretch and how far into it, 0 to 1.
  struct Within {
    const Stretch& stretch;
    double x;
  };
  Within within(double step) const;
  void add(std::int64_t count, const Path::Via& from, const Path::Via& to, const Place& place);
  double duration_of(const Stretch& stretch) const { return static_cast<double>(stretch.count) / step_rate_; }
  std::string to_text(const Path::Via& point) const;
  std::string to_text(const Eigen::Vector3d& point) const;

  std::vector<int> axes_;
  std::vector<Stretch> stretches_;  ///< of one lap
  std::int64_t laps_ = 1;
  double step_rate_ = 0;
};

}  // namespace mixloop
