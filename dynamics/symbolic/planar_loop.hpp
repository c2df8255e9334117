// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "dynamics/procedure/model.hpp"
#include "dynamics/symbolic/expression.hpp"

namespace mixloop {

/// A vector in a plane, as a complex number.
struct Planar {
  Expression x = 0.0, y = 0.0;

  friend Planar operator+(const Planar& a, const Planar& b) { return {a.x + b.x, a.y + b.y}; }
  friend Planar operator-(const Planar& a, const Planar& b) { return {a.x - b.x, a.y - b.y}; }
  friend Planar operator-(const Planar& a) { return {-a.x, -a.y}; }
  friend Planar operator*(const Planar& a, const Planar& b) {
    return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
  }
  friend Planar operator*(const Planar& a, const Expression& s) { return {a.x * s, a.y * s}; }
  Planar conjugate() const { return {x, -y}; }
};

/// Re(a conj(b)) and Im(conj(a) b): the scalar and the vector product.
inline Expression dot(const Planar& a, const Planar& b) { return a.x * b.x + a.y * b.y; }
inline Expression cross(const Planar& a, const Planar& b) { return a.x * b.y - a.y * b.x; }

/// Whole multiples of coordinates: which angle a direction has turned by.
using WholeSum = std::map<int, int>;

/// One vector of a loop in a plane: by a sum of coordinates turned, and where it slides, as long as one is.
struct LoopVector {
  Planar is;
  WholeSum turned;
  int length = -1;
};

/// A loop of links that all turn about one direction: the vectors from the closure's first point to its
/// second, whose sum is nothing when it is closed.
struct PlanarLoop {
  std::vector<LoopVector> vectors;
  bool has_axes = false;  ///< the plane is that of two of the axes in which closures have their rows
};

/// The loop that a closure between two points makes; nothing where it isn't planar.
std::optional<PlanarLoop> planar_loop(const Model<Expression>& model, int closure);

}  // namespace mixloop
