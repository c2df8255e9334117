// SPDX-License-Identifier: MIT
// Drives that aren't ideal, of one run or of one a lane: plant/actuators.hpp has what they do, in the same
// order of operations. This text also goes into every kernel.
#pragma once

#include "sweep/kernel/lanes.hpp"
#include "sweep/kernel/loop_data.hpp"

namespace mixloop_loop {

/// A function of the C library, by which other lanes need not wait: where a lane's argument is the one of
/// before, so is the result.
template <class Real>
class Remembered {
 public:
  template <class Function>
  MIXLOOP_INLINE const Real& of(const Real& x, const Function& function) {
    for (int lane = 0; lane < Memory<Real>::kLanes; ++lane) {
      const double now = Memory<Real>::get(x, lane);
      if (now == Memory<Real>::get(x_, lane)) continue;
      Memory<Real>::put(x_, lane, now);
      Memory<Real>::put(result_, lane, function(now));
    }
    return result_;
  }

 private:
  Real x_ = mixloop_functions::lift<Real>((double)NAN), result_ = x_;
};

template <class Real, int n_u>
class Drives {
 public:
  MIXLOOP_FUNCTION void load(const Each& each, const Common& common, int first) {
    Real* const values[] = {rate_, lag_, ripple_, per_turn_, viscous_, coulomb_, smooth_};
    for (int what = 0; what < kDriveNumbers; ++what)
      for (int i = 0; i < n_u; ++i)
        values[what][i] = Memory<Real>::load(each.drives, what * n_u + i, common.runs, first);
    for (int i = 0; i < n_u; ++i) u_[i] = r_[i] = y_[i] = mixloop_functions::lift<Real>(0.0);
  }

  /// `u` is asked for from now on, at the tick's start or where a command is due; the first one finds the
  /// drives settled on it.
  MIXLOOP_FUNCTION void take(const Real* u, bool is_due, bool is_first) {
    place_ = is_due ? kPlaces / 2 : 0;
    for (int i = 0; i < n_u; ++i) {
      u_[i] = u[i];
      if (is_first) r_[i] = y_[i] = u[i];
    }
  }

  /// What acts `s` after that.
  MIXLOOP_FUNCTION void torque(int stage, const Real& s, const Real* psi, const Real* psid, Real* tau) {
    for (int i = 0; i < n_u; ++i) {
      Real torque = lagged(i, place_ + stage, s);
      if (any_above(ripple_[i], 0)) {
        const Real waves = each_lane((Real)(per_turn_[i] * psi[i]), [](double x) { return ::sin(x); });
        torque = chosen<Real>(ripple_[i] > 0.0, torque * (1.0 + ripple_[i] * waves), torque);
      }
      torque = torque - viscous_[i] * psid[i];
      if (any_above(coulomb_[i], 0)) {
        const Real share = each_lane((Real)(psid[i] / smooth_[i]), [](double x) { return ::tanh(x); });
        torque = chosen<Real>(coulomb_[i] > 0.0, torque - coulomb_[i] * share, torque);
      }
      tau[i] = torque;
    }
  }

  /// `s` goes by, where it is any.
  MIXLOOP_FUNCTION void pass(const Real& s) {
    for (int i = 0; i < n_u; ++i) {
      const Real y = lagged(i, place_ + kEnd, s), r = ramp(i, s);
      y_[i] = chosen<Real>(s > 0.0, y, y_[i]);
      r_[i] = chosen<Real>(s > 0.0, r, r_[i]);
    }
  }

  /// When, after `s`, a torque next has a kink: a ramp that no lag smooths is over.
  MIXLOOP_FUNCTION Real next_kink(const Real& s) const {
    Real next = mixloop_functions::lift<Real>((double)HUGE_VAL);
    for (int i = 0; i < n_u; ++i) {
      Real end = ramp_time(i);
      end = chosen<Real>(lag_[i] == 0.0, chosen<Real>(end > s, end, next), next);
      next = chosen<Real>(end < next, end, next);
    }
    return next;
  }

 private:
  static constexpr int kEnd = 3, kPlaces = 8;  // three stages and the end, before and after a command

  MIXLOOP_INLINE Real ramp_time(int i) const { return magnitude((Real)(u_[i] - r_[i])) / rate_[i]; }
  /// `x` with the sign of `of`.
  MIXLOOP_INLINE static Real signed_as(const Real& of, const Real& x) {
    return chosen<Real>(of < 0.0, (Real)-x, x);
  }
  MIXLOOP_INLINE Real ramp(int i, const Real& s) const {
    const Real way = u_[i] - r_[i];
    return chosen<Real>(s >= ramp_time(i), u_[i], r_[i] + signed_as(way, rate_[i] * s));
  }
  MIXLOOP_FUNCTION Real lagged(int i, int place, const Real& s) {
    const Real straight = ramp(i, s);
    if (!any_above(lag_[i], 0)) return straight;
    const Real end = ramp_time(i), on_ramp = chosen<Real>(end < s, end, s);
    const Real slope = signed_as((Real)(u_[i] - r_[i]), rate_[i]);
    Real at = y_[i];
    if (any_above(on_ramp, 0)) {
      const Real part = -on_ramp / lag_[i];
      const Real less = less_[i][place].of(part, [](double x) { return ::expm1(x); });
      const Real left = left_[i][place].of(part, [](double x) { return ::exp(x); });
      at = chosen<Real>(on_ramp > 0.0, r_[i] + slope * (on_ramp + lag_[i] * less) + (y_[i] - r_[i]) * left,
                        at);
    }
    const Real left = after_[i][place].of((Real)(-(s - end) / lag_[i]), [](double x) { return ::exp(x); });
    at = chosen<Real>(s > end, u_[i] + (at - u_[i]) * left, at);
    return chosen<Real>(lag_[i] == 0.0, straight, at);
  }

  Real rate_[n_u], lag_[n_u], ripple_[n_u], per_turn_[n_u], viscous_[n_u], coulomb_[n_u], smooth_[n_u];
  Real u_[n_u], r_[n_u], y_[n_u];
  int place_ = 0;
  Remembered<Real> less_[n_u][kPlaces], left_[n_u][kPlaces], after_[n_u][kPlaces];
};

}  // namespace mixloop_loop
