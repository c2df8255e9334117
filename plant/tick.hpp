// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "plant/plant_model.hpp"
#include "plant/plant_state.hpp"

namespace mixloop {

// A plant's tick on any scalar and by any drives. `drives` have take(state, tau): tau acts from now on; and
// integrate(state, t, length): goes on from time t over `length` s.

/// Over `length` s from time t.
template <class T, class Drives>
void move_on(IdealState<T>& state, double t, double length, Drives&& drives) {
  if (length > 0) drives.integrate(state, t, length);
}

/// The state at tick 0, at rest unless rates are given.
template <class T>
IdealState<T> state_at(const PlantModel& model, std::span<const T> psi0, std::span<const T> psid0 = {}) {
  const auto n = static_cast<Eigen::Index>(model.n), n_u = static_cast<Eigen::Index>(model.n_u);
  IdealState<T> state{.x = Vec<T>::Zero(2 * n + 1), .applied = Vec<T>::Zero(n_u)};
  std::copy(psi0.begin(), psi0.end(), state.x.data());
  std::copy(psid0.begin(), psid0.end(), state.x.data() + n);
  state.commands.assign(model.delay_ticks + 2, state.applied);
  return state;
}

/// Takes the tick's command, which acts after the delay. The robot starts held: COMMAND(0) also acts before
/// it is due.
template <class T, class Drives>
void take_command(const PlantModel& model, IdealState<T>& state, std::span<const T> tau, Drives&& drives) {
  auto& ring = state.commands;
  const auto slot = static_cast<std::size_t>(state.tick) % ring.size();
  ring[slot] = map_of(tau);
  if (state.tick == 0) std::fill(ring.begin(), ring.end(), ring[slot]);
  const std::size_t age = model.delay_ticks + (model.delay_rest > 0 ? 1 : 0);
  drives.take(state, span_of(std::as_const(ring[(slot + ring.size() - age) % ring.size()])));
}

/// Goes on to the next tick, the commands held.
template <class T, class Drives>
void advance_tick(const PlantModel& model, IdealState<T>& state, Drives&& drives) {
  const auto& ring = state.commands;
  const double t = model.time(state.tick), rest = model.delay_rest;
  const std::size_t slot =
      (static_cast<std::size_t>(state.tick) + ring.size() - model.delay_ticks) % ring.size();
  move_on(state, t, rest, drives);
  drives.take(state, span_of(ring[slot]));
  move_on(state, t + rest, model.tick_length() - rest, drives);
  ++state.tick;
}

/// Goes on within the tick to `offset` s after its start; from there on `tau` acts. Offsets of a tick don't
/// fall; those before what is reached act there.
template <class T, class Drives>
void take_effect(const PlantModel& model, IdealState<T>& state, double offset, std::span<const T> tau,
                 Drives&& drives) {
  const double to = std::clamp(offset, state.within, model.tick_length());
  move_on(state, model.time(state.tick) + state.within, to - state.within, drives);
  state.within = to;
  drives.take(state, tau);
}

/// Goes on to the next tick from where take_effect left it, or from the tick's start.
template <class T, class Drives>
void finish_tick(const PlantModel& model, IdealState<T>& state, Drives&& drives) {
  move_on(state, model.time(state.tick) + state.within, model.tick_length() - state.within, drives);
  state.within = 0;
  ++state.tick;
}

}  // namespace mixloop
