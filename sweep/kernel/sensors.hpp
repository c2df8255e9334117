// SPDX-License-Identifier: MIT
// Sensors that aren't ideal, of one run or of one a lane: plant/sensors.hpp has what they do, in the same
// order of operations. This text also goes into every kernel.
#pragma once

#include "plant/chance.hpp"
#include "sweep/kernel/lanes.hpp"
#include "sweep/kernel/loop_data.hpp"

namespace mixloop_loop {

template <class Real, int n>
class Sensors {
 public:
  MIXLOOP_FUNCTION void load(const Each& each, const Common& common, int first) {
    Real* const values[] = {resolution_, noise_, bias_};
    for (int what = 0; what < kSensorNumbers; ++what)
      for (int i = 0; i < n; ++i)
        values[what][i] = Memory<Real>::load(each.sensors, what * n + i, common.runs, first);
    share_ = Memory<Real>::load(each.velocity_share, 0, common.runs, first);
    for (int lane = 0; lane < Memory<Real>::kLanes; ++lane)
      chance_[lane] = mixloop::Chance(each.seeds[Memory<Real>::at(first, lane, common.runs)]);
    for (int i = 0; i < n; ++i) before_[i] = filtered_[i] = mixloop_functions::lift<Real>(0.0);
    runs_ = common.runs;
    rate_ = common.rate;
    differentiated_ = common.differentiated;
    delay_ = each.sensor_delay;
    first_ = first;
  }

  /// What is said at tick k of psi and psid (n each) at `x`.
  MIXLOOP_FUNCTION void measure(long long k, const Told& told, const Real* x, Real* psi, Real* psid) {
    for (int i = 0; i < n; ++i) {
      psi[i] = position(k, i, x[i]);
      psid[i] = differentiated_ ? difference(k, i, psi[i]) : x[n + i];
      if (told.sensor_ticks == 1) continue;
      put(told, k, i, psi[i]);
      put(told, k, n + i, psid[i]);
      psi[i] = delayed(told, k, i, i);
      psid[i] = delayed(told, k, n + i, i);
    }
  }

 private:
  MIXLOOP_FUNCTION Real position(long long k, int i, const Real& psi) const {
    Real at = psi + bias_[i];
    if (any_above(noise_[i], 0)) {
      Real normal = at;
      for (int lane = 0; lane < Memory<Real>::kLanes; ++lane)
        Memory<Real>::put(normal, lane, chance_[lane].normal(k, (unsigned)i, mixloop::Draw::noise));
      at = chosen<Real>(noise_[i] > 0.0, at + noise_[i] * normal, at);
    }
    if (any_above(resolution_[i], 0)) {
      const Real steps = each_lane((Real)(at / resolution_[i]), [](double x) { return ::nearbyint(x); });
      at = chosen<Real>(resolution_[i] > 0.0, resolution_[i] * steps, at);
    }
    return at;
  }

  MIXLOOP_FUNCTION Real difference(long long k, int i, const Real& position) {
    Real difference = mixloop_functions::lift<Real>(0.0);
    if (k > 0) difference = (position - before_[i]) * rate_;
    before_[i] = position;
    filtered_[i] =
        chosen<Real>(share_ < 1.0, filtered_[i] + share_ * (difference - filtered_[i]), difference);
    return filtered_[i];
  }

  MIXLOOP_FUNCTION void put(const Told& told, long long k, int what, const Real& value) const {
    const int slot = (int)(k % told.sensor_ticks), end = k == 0 ? told.sensor_ticks : slot + 1;
    for (int tick = slot; tick < end; ++tick)
      Memory<Real>::store(told.sensor_ring, tick * 2 * n + what, runs_, first_, value);
  }
  /// As old as the sensor's delay; the first tick's stands for what is older.
  MIXLOOP_FUNCTION Real delayed(const Told& told, long long k, int what, int i) const {
    Real value = mixloop_functions::lift<Real>(0.0);
    for (int lane = 0; lane < Memory<Real>::kLanes; ++lane) {
      const int run = Memory<Real>::at(first_, lane, runs_);
      const long long at = k - (long long)delay_[i * runs_ + run];
      Memory<Real>::put(
          value, lane,
          told.sensor_ring[((at < 0 ? 0 : at % told.sensor_ticks) * 2 * n + what) * runs_ + run]);
    }
    return value;
  }

  Real resolution_[n], noise_[n], bias_[n], share_, before_[n], filtered_[n];
  mixloop::Chance chance_[Memory<Real>::kLanes];
  const double* delay_;
  double rate_;
  int runs_, first_, differentiated_;
};

}  // namespace mixloop_loop
