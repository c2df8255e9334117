// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "report/envelope.hpp"
#include "report/tick.hpp"

namespace mixloop {

/// How far the end effector was from where it should be, over all judged ticks that tell.
struct TrackingError {
  double max = kUnknown, time_of_max = kUnknown, final = kUnknown, rms = kUnknown;  ///< m, s, m, m
};

/// The curves of one run, drawn tick by tick: what ticks say, and what follows from it (errors along the path
/// and across it, powers, what of the motors' work is no energy of the mechanism).
class Curves {
 public:
  /// `axes`: which of x, y, z the path prescribes; `capacity`: see Envelope.
  Curves(std::vector<int> axes, double rate_hz, std::size_t capacity);

  /// The next tick; one that nothing is known of leaves a gap.
  void add(const Tick& tick);
  void coarsen();

  struct Curve {
    std::string name;  ///< e.g. "error_along", "tau_1"; units as in Tick
    Envelope envelope;
  };
  /// Those that nothing is known of are empty; none before the first tick.
  const std::vector<Curve>& all() const { return curves_; }
  std::int64_t width() const { return curves_.empty() ? 1 : curves_.front().envelope.width(); }
  std::int64_t ticks() const { return ticks_; }
  TrackingError tracking_error() const;

 private:
  template <class... Parts>
  void put(double value, const char* name, const Parts&... parts);
  void put_error(const Tick& tick);
  void put_energy(const Tick& tick);
  void measure(double error, double t);

  std::vector<int> axes_;
  double rate_hz_;
  std::size_t capacity_;
  std::vector<Curve> curves_;
  std::size_t next_ = 0;  ///< the curve that put() adds to
  std::int64_t ticks_ = 0;

  Eigen::Vector3d heading_ = Eigen::Vector3d::Constant(kUnknown);  ///< of the path, where it last moved
  Eigen::Vector3d place_ = heading_;                               ///< desired, of the latest tick
  double path_length_ = 0;
  double energy_ = kUnknown, work_ = kUnknown, first_energy_ = kUnknown;
  TrackingError error_;
  double sum_of_squares_ = 0;
  std::int64_t errors_ = 0;
};

}  // namespace mixloop
