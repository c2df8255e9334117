// SPDX-License-Identifier: MIT
// The closed loop of one run, or of one a lane: the plant by Runge and Kutta's classical method, the control
// law, and what is measured of them, in the order of a simulation's operations, so that the bits are the
// same. This text goes behind a scene's programs into a file of its own, for the processor's vectors or for a
// graphics processor, so it stands alone.
#pragma once

#include "sweep/kernel/drives.hpp"
#include "sweep/kernel/lanes.hpp"
#include "sweep/kernel/loop_data.hpp"
#include "sweep/kernel/sensors.hpp"

namespace mixloop_loop {

/// Programs has n, n_u, the sizes of constants, the scene's evaluations (plant, mass, bias, hand), and
/// whether there are sensors and drives that aren't ideal.
template <class Real, class Programs>
class Loop {
  static constexpr int n = Programs::n, n_u = Programs::n_u, size = 2 * n + 1;
  static constexpr int row = 3 * n_u + 9;

 public:
  MIXLOOP_FUNCTION Loop(const Common& common, const Each& each, const Told& told, int first)
      : common_(common), each_(each), told_(told), first_(first) {
    for (int i = 0; i < n_u; ++i) {
      kp_[i] = load(each.kp, i);
      kv_[i] = load(each.kv, i);
      torque_limit_[i] = load(each.torque_limit, i);
      most_torque_[i] = not_a_number();
    }
    for (int i = 0; i < Programs::plant_constants; ++i) plant_k_[i] = load(each.plant_constants, i);
    for (int i = 0; i < Programs::mass_constants; ++i) mass_k_[i] = load(each.mass_constants, i);
    for (int i = 0; i < Programs::bias_constants; ++i) bias_k_[i] = load(each.bias_constants, i);
    for (int i = 0; i < Programs::hand_constants; ++i) hand_k_[i] = load(each.hand_constants, i);
    for (int i = 0; i < size; ++i) x_[i] = mixloop_functions::lift<Real>(0.0);
    for (int i = 0; i < n; ++i) x_[i] = load(each.psi0, i);
    if constexpr (Programs::sensors) sensors_.load(each, common, first);
    if constexpr (Programs::drives) drives_.load(each, common, first);
    rest_ = load(each.delay_rest, 0);
    error_limit_ = load(each.error_limit, 0);
    alive_ = mixloop_functions::lift<Real>(1.0);
    recorded_ = squares_ = errors_ = mixloop_functions::lift<Real>(0.0);
    most_error_ = most_error_tick_ = last_error_ = settled_tick_ = not_a_number();
  }

  MIXLOOP_FUNCTION void run() {
    state(0);
    for (long long k = 0; k <= common_.ticks && any_alive(); ++k) {
      command(k);
      if (k == common_.ticks) break;
      advance(k);
      state(k + 1);
    }
    store(told_.ticks_recorded, 0, recorded_);
    store(told_.most_error, 0, most_error_);
    store(told_.most_error_tick, 0, most_error_tick_);
    store(told_.last_error, 0, last_error_);
    store(told_.squares, 0, squares_);
    store(told_.errors, 0, errors_);
    store(told_.settled_tick, 0, settled_tick_);
    for (int i = 0; i < n_u; ++i) store(told_.most_torque, i, most_torque_[i]);
  }

 private:
  MIXLOOP_INLINE Real load(const double* from, long long i) const {
    return Memory<Real>::load(from, i, common_.runs, first_);
  }
  MIXLOOP_INLINE void store(double* to, long long i, const Real& x) const {
    Memory<Real>::store(to, i, common_.runs, first_, x);
  }
  MIXLOOP_INLINE static Real not_a_number() { return mixloop_functions::lift<Real>((double)NAN); }
  MIXLOOP_INLINE static Real number(double x) { return mixloop_functions::lift<Real>(x); }
  MIXLOOP_INLINE bool any_alive() const { return any_above(alive_, 0); }
  MIXLOOP_INLINE Real reference(long long k, int i) const { return number(common_.references[k * row + i]); }

  // What diverged stands still, so that it holds up nobody.
  MIXLOOP_FUNCTION void end_where(const Real& finite) {
    alive_ = chosen<Real>(finite == 0.0, alive_, number(0.0));
    for (int i = 0; i < size; ++i) x_[i] = chosen<Real>(alive_ > 0.0, x_[i], number(0.0));
  }

  // Not finite, or too far from the path.
  MIXLOOP_FUNCTION void state(long long k) {
    Real sum = number(0.0);
    for (int i = 0; i < size; ++i) sum = sum + (x_[i] - x_[i]);
    end_where(sum);
    Real hand[3];
    Programs::hand((const Real*)x_, (const Real*)(x_ + n), (const Real*)nullptr, time(k),
                   (const Real*)hand_k_, hand);
    Real squared = number(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      if (!common_.axes[axis]) continue;
      const Real off = hand[axis] - reference(k, 3 * n_u + axis);
      squared = squared + off * off;
    }
    error_ = mixloop_functions::root(squared);
    end_where(chosen<Real>(error_ <= error_limit_, number(0.0), number(1.0)));
  }

  MIXLOOP_INLINE Real time(long long k) const { return number((double)k / common_.rate); }

  // (33) and its kin.
  MIXLOOP_FUNCTION void command(long long k) {
    Real tau[n_u], psi[n], psid[n], psidd[n_u];
    if constexpr (Programs::sensors)
      sensors_.measure(k, told_, x_, psi, psid);
    else
      for (int i = 0; i < n; ++i) psi[i] = x_[i], psid[i] = x_[n + i];
    for (int i = 0; i < n_u; ++i) {
      psidd[i] = reference(k, 2 * n_u + i);
      const Real off = reference(k, i) - psi[i], late = reference(k, n_u + i) - psid[i];
      tau[i] = kp_[i] * off + kv_[i] * late;
    }
    for (int i = 0; i < n_u && common_.at_desired; ++i)
      psi[i] = reference(k, i), psid[i] = reference(k, n_u + i);
    for (int i = 0; i < n && common_.at_rest; ++i) psid[i] = number(0.0);
    Real more[n];
    if (common_.feedforward) {
      Programs::mass(psi, psid, psidd, time(k), (const Real*)mass_k_, more);
      for (int i = 0; i < n_u; ++i) tau[i] = tau[i] + more[i];
    }
    if (common_.bias) {
      Programs::bias(psi, psid, (const Real*)nullptr, time(k), (const Real*)bias_k_, more);
      for (int i = 0; i < n_u; ++i) tau[i] = tau[i] + more[i];
    }
    Real sum = number(0.0);
    for (int i = 0; i < n_u; ++i) sum = sum + (tau[i] - tau[i]);
    end_where(sum);
    for (int i = 0; i < n_u; ++i) {
      store(told_.ring, (k % told_.ring_ticks) * n_u + i, tau[i]);
      if (k == 0)
        for (int tick = 1; tick < told_.ring_ticks; ++tick) store(told_.ring, tick * n_u + i, tau[i]);
    }
    measure(k, tau);
  }

  MIXLOOP_FUNCTION void measure(long long k, const Real* tau) {
    const auto keep = [&](Real& before, const Real& now) {
      before = chosen<Real>(alive_ > 0.0, now, before);
    };
    if (told_.trajectory != nullptr) {
      double* to = told_.trajectory + k * (2 * n + n_u) * common_.runs;
      for (int i = 0; i < 2 * n; ++i) store(to, i, x_[i]);
      for (int i = 0; i < n_u; ++i) store(to, 2 * n + i, tau[i]);
    }
    keep(recorded_, number((double)(k + 1)));
    for (int i = 0; i < n_u; ++i) {
      Real most = most_torque_[i];
      raise(most, magnitude(tau[i]));
      keep(most_torque_[i], most);
    }
    if (k < common_.start_tick) return;
    keep(most_error_tick_, chosen<Real>(error_ <= most_error_, most_error_tick_, number((double)k)));
    Real most = most_error_;
    raise(most, error_);
    keep(most_error_, most);
    keep(last_error_, error_);
    if (common_.settled_within >= 0) {
      const Real begun = chosen<Real>(settled_tick_ <= number((double)k), settled_tick_, number((double)k));
      keep(settled_tick_, chosen<Real>(error_ <= number(common_.settled_within), begun, not_a_number()));
    }
    const Real square = error_ * error_;
    keep(squares_, squares_ + square);
    keep(errors_, errors_ + 1.0);
  }

  // The command so many ticks old, each run its own; before there is one the first.
  MIXLOOP_FUNCTION void take(long long k, bool due) {
    for (int i = 0; i < n_u; ++i) {
      Real tau = number(0.0);
      for (int lane = 0; lane < Memory<Real>::kLanes; ++lane) {
        const int run = Memory<Real>::at(first_, lane, common_.runs);
        long long at = k - (long long)each_.delay_ticks[run];
        if (!due && each_.delay_rest[run] > 0) --at;
        at = at < 0 ? 0 : at % told_.ring_ticks;
        Memory<Real>::put(tau, lane, told_.ring[(at * n_u + i) * common_.runs + run]);
      }
      applied_[i] = within(tau, torque_limit_[i]);
    }
    if constexpr (Programs::drives) drives_.take(applied_, due, k == 0 && !due);
  }

  MIXLOOP_FUNCTION void advance(long long k) {
    take(k, false);
    if (any_above(rest_, 0)) {
      move_on(time(k), rest_);
      take(k, true);
    }
    move_on(time(k) + rest_, common_.tick_length - rest_, true);
  }

  /// Where `length` is none, nothing moves; `everywhere`: there is some. With drives pieces end where a
  /// torque has a kink.
  MIXLOOP_FUNCTION void move_on(const Real& t, const Real& length, bool everywhere = false) {
    if constexpr (!Programs::drives) {
      if (everywhere)
        integrate(number(0.0), t, length);
      else
        integrate_where(number(0.0), length, t, length);
    } else {
      (void)everywhere;
      Real done = number(0.0);
      while (any_above(length - done, 0)) {
        Real end = drives_.next_kink(done);
        end = chosen<Real>(end < length * (1.0 - 1e-9), end, length);
        integrate_where(done, length, t + done, end - done);
        done = chosen<Real>(done < length, end, done);
      }
      drives_.pass(length);
    }
  }
  MIXLOOP_FUNCTION void integrate_where(const Real& done, const Real& whole, const Real& t,
                                        const Real& length) {
    Real before[size];
    for (int i = 0; i < size; ++i) before[i] = x_[i];
    integrate(done, t, length);
    for (int i = 0; i < size; ++i) x_[i] = chosen<Real>(done < whole, x_[i], before[i]);
  }

  /// `s` after the drives were asked; `stage` of the method, from 0.
  MIXLOOP_FUNCTION void rate_of(int stage, const Real& s, const Real& t, const Real* x, Real* dx) {
    for (int i = 0; i < n; ++i) dx[i] = x[n + i];
    if constexpr (Programs::drives)
      drives_.torque(stage, s, x, x + n, applied_);
    else
      (void)stage, (void)s;
    Programs::plant(x, x + n, (const Real*)applied_, t, (const Real*)plant_k_, dx + n);
    Real power = applied_[0] * x[n];
    for (int i = 1; i < n_u; ++i) power = power + applied_[i] * x[n + i];
    dx[2 * n] = power;
  }

  // Hairer, Norsett & Wanner, Solving ODEs I, II.1, table 1.2.
  MIXLOOP_FUNCTION void integrate(const Real& done, const Real& t, const Real& length) {
    const Real h = length / (double)common_.substeps, half = h / 2.0, sixth = h / 6.0;
    Real k1[size], k2[size], k3[size], k4[size], x[size];
    for (int step = 0; step < common_.substeps; ++step) {
      const Real begin = (step + 0.0) * h, middle = (step + 0.5) * h, end = (step + 1.0) * h;
      rate_of(0, done + begin, t + begin, x_, k1);
      for (int i = 0; i < size; ++i) x[i] = x_[i] + half * k1[i];
      rate_of(1, done + middle, t + middle, x, k2);
      for (int i = 0; i < size; ++i) x[i] = x_[i] + half * k2[i];
      rate_of(1, done + middle, t + middle, x, k3);
      for (int i = 0; i < size; ++i) x[i] = x_[i] + h * k3[i];
      rate_of(2, done + end, t + end, x, k4);
      for (int i = 0; i < size; ++i) x_[i] = x_[i] + sixth * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
  }

  const Common& common_;
  const Each& each_;
  const Told& told_;
  int first_;
  Sensors<Real, n> sensors_;
  Drives<Real, n_u> drives_;
  Real x_[size], applied_[n_u], kp_[n_u], kv_[n_u], torque_limit_[n_u], most_torque_[n_u];
  Real plant_k_[Programs::plant_constants + 1], mass_k_[Programs::mass_constants + 1];
  Real bias_k_[Programs::bias_constants + 1], hand_k_[Programs::hand_constants + 1];
  Real rest_, error_limit_, error_, alive_, recorded_, most_error_, most_error_tick_, last_error_, squares_,
      errors_, settled_tick_;
};

}  // namespace mixloop_loop
