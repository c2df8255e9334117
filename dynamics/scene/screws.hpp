// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// A pose, with or without a joint in it, as screws about z and x in turn: what transforms are made of.
/// What is zero is left out and neighbours about one axis are one, so that it takes as few as it can.
class Screws {
 public:
  explicit Screws(Place place) : place_(std::move(place)) {}

  void turn_z(const Formula& angle) { add(true, angle, zero(kLength)); }
  void move_z(const Formula& shift) { add(true, zero(kPure), shift); }
  void turn_x(const Formula& angle) { add(false, angle, zero(kLength)); }
  void move_x(const Formula& shift) { add(false, zero(kPure), shift); }

  /// One transform or more, with nothing but their numbers and place.
  std::vector<Scene::Transform> transforms() const;

 private:
  struct Screw {
    bool about_z = false;
    Formula angle, shift;  ///< rad, m
  };

  Formula zero(const Dimension& dimension) const { return constant_formula(0, dimension, place_); }
  void add(bool about_z, const Formula& angle, const Formula& shift);

  Place place_;
  std::vector<Screw> screws_;
};

/// Their sum and opposite; of constants, constants.
Formula sum_of(const Formula& left, const Formula& right);
Formula opposite_of(const Formula& formula);

}  // namespace mixloop
