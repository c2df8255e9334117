// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// What each independent coordinate has, of one dimension where it turns and of another where it slides.
struct Quantity {
  Dimension rotary, linear;

  const Dimension& of(const Scene::Independent& coordinate) const {
    return coordinate.linear ? linear : rotary;
  }
  friend Quantity operator/(const Quantity& a, const Quantity& b) {
    return {a.rotary / b.rotary, a.linear / b.linear};
  }
};
inline constexpr Quantity kNumber{kPure, kPure}, kSeconds{kTime, kTime};
inline constexpr Quantity kPosition{kPure, kLength}, kTorque{kMoment, kForce};
inline constexpr Quantity kVelocity{kFrequency, {2, 0, -2, false}};

/// SI units of what acts on a coordinate, and of where it is.
constexpr const char* torque_unit(bool linear) { return linear ? "N" : "N m"; }
constexpr const char* position_unit(bool linear) { return linear ? "m" : "rad"; }

/// What a message calls one of these: a motor, where all of them are driven.
std::string_view noun_for(std::span<const Scene::Independent> coordinates);

/// One value for each of `coordinates`: a scene's motors(), or all its independent ones. Throws InputError.
std::vector<double> read_values(const NodePtr& node, std::span<const Scene::Independent> coordinates,
                                const Quantity& quantity, const char* what);

}  // namespace mixloop
