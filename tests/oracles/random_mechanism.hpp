// SPDX-License-Identifier: MIT
// Seeded random mechanisms, told twice: as a scene's text for the loader, and as a tree with constraints
// whose derivatives are worked out by hand here. All numbers are multiples of 1/1024, so that text, double
// and wide float hold the same ones.
#pragma once

#include <random>
#include <string>

#include "tests/oracles/multipliers.hpp"

namespace mixloop::oracle {

/// A multiple of 1/1024.
struct Dyadic {
  int units = 0;

  template <class T>
  T as() const {
    return T(units) / 1024;
  }
  std::string text() const;  ///< all of its decimals, in parentheses when negative
};

struct MechanismKind {
  bool nonlinear = false;  ///< constraints in products and sines of the motors
  bool timed = false;      ///< constraints and loads that depend on time
  bool loads = false;
  bool springs = false;
  bool friction = false;  ///< viscous
};

/// One mechanism: n motors, a tree with a body on each frame, and for each coordinate
///   f = offset + sum_i linear_i psi_i + chain q_previous + wave sin(frequency psi_a + phase + tempo t)
///         + product psi_b psi_c + drift t^2 + sweep t psi_d.
class RandomMechanism {
 public:
  RandomMechanism(std::uint64_t seed, MechanismKind kind);

  int n() const { return n_; }
  int m() const { return static_cast<int>(coordinates_.size()); }
  /// The scene, as a file of docs/scenes.md's format.
  std::string scene_text() const;
  /// The tree with the loads of time t.
  template <class T>
  Tree<T> tree(const T& t) const;
  template <class T>
  ConstraintState<T> constraints(const VectorX<T>& psi, const VectorX<T>& psid, const T& t) const;

 private:
  class Dice;
  struct Coordinate {
    bool linear_motion = false;  // a length
    Dyadic offset, chain, wave, frequency, phase, tempo, product, drift, sweep;
    std::vector<Dyadic> linear;
    int a = 0, b = 0, c = 0, d = 0;
    std::string text(int index) const;
  };
  struct Frame {
    int parent = -1, coordinate = -1;
    Dyadic theta, s, a, alpha, scale;
  };
  struct Body {
    Dyadic mass, centre[3], inertia[6];  // xx yy zz xy xz yz
  };
  struct Load {
    int frame = 0;
    Dyadic point[3], force[3], moment[3], tempo;  // all of it times cos(tempo t)
  };

  struct Spring {
    int coordinate = 0;
    Dyadic stiffness, rest, damping;
  };

  Coordinate random_coordinate(int j, MechanismKind kind, Dice& dice) const;
  Frame random_frame(int i, Dice& dice) const;
  static Body random_body(Dice& dice);
  Load random_load(MechanismKind kind, Dice& dice) const;
  Spring random_spring(MechanismKind kind, Dice& dice) const;
  std::string transforms_text() const;
  std::string bodies_text() const;
  std::string loads_text() const;

  int n_ = 0;
  std::vector<Coordinate> coordinates_;
  std::vector<Frame> frames_;
  std::vector<Body> bodies_;
  std::vector<Load> loads_;
  std::vector<Spring> springs_;
  Dyadic gravity_[3];
};

template <class T>
Tree<T> RandomMechanism::tree(const T& t) const {
  using std::cos;
  const auto vector = [](const Dyadic* x) { return Vector3<T>(x[0].as<T>(), x[1].as<T>(), x[2].as<T>()); };
  Tree<T> tree;
  tree.coordinates = m();
  tree.gravity = vector(gravity_);
  for (const Frame& frame : frames_) {
    Motion motion = Motion::fixed;
    if (frame.coordinate >= 0)
      motion = coordinates_[static_cast<std::size_t>(frame.coordinate)].linear_motion ? Motion::prismatic
                                                                                      : Motion::revolute;
    tree.frames.push_back({frame.parent, frame.theta.as<T>(), frame.s.as<T>(), frame.a.as<T>(),
                           frame.alpha.as<T>(), motion, frame.coordinate, frame.scale.as<T>()});
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const auto I = [&](int k) { return body.inertia[k].as<T>(); };
    Matrix3<T> inertia;
    inertia << I(0), I(3), I(4), I(3), I(1), I(5), I(4), I(5), I(2);
    tree.bodies.push_back({static_cast<int>(i), body.mass.as<T>(), vector(body.centre), inertia});
  }
  for (const Load& load : loads_) {
    const T strength = cos(T(load.tempo.as<T>() * t));
    tree.loads.push_back(
        {load.frame, vector(load.point), vector(load.force) * strength, vector(load.moment) * strength});
  }
  for (const Spring& spring : springs_)
    tree.springs.push_back(
        {spring.coordinate, spring.stiffness.as<T>(), spring.rest.as<T>(), spring.damping.as<T>()});
  return tree;
}

template <class T>
ConstraintState<T> RandomMechanism::constraints(const VectorX<T>& psi, const VectorX<T>& psid,
                                                const T& t) const {
  using std::cos;
  using std::sin;
  ConstraintState<T> state{VectorX<T>::Zero(m()), VectorX<T>::Zero(m()), VectorX<T>::Zero(m()),
                           MatrixX<T>::Zero(m(), n())};
  for (int j = 0; j < m(); ++j) {
    const Coordinate& f = coordinates_[static_cast<std::size_t>(j)];
    const T wave = f.wave.as<T>(), frequency = f.frequency.as<T>(), tempo = f.tempo.as<T>();
    const T argument = frequency * psi[f.a] + f.phase.as<T>() + tempo * t;
    const T argument_rate = frequency * psid[f.a] + tempo;
    const T product = f.product.as<T>(), drift = f.drift.as<T>(), sweep = f.sweep.as<T>();
    T value = f.offset.as<T>() + wave * sin(argument) + product * psi[f.b] * psi[f.c] + drift * t * t +
              sweep * t * psi[f.d];
    for (int i = 0; i < n(); ++i) {
      value += f.linear[static_cast<std::size_t>(i)].as<T>() * psi[i];
      state.C(j, i) = f.linear[static_cast<std::size_t>(i)].as<T>();
    }
    state.C(j, f.a) += wave * frequency * cos(argument);
    state.C(j, f.b) += product * psi[f.c];
    state.C(j, f.c) += product * psi[f.b];
    state.C(j, f.d) += sweep * t;
    // The rest of q' beside C psi', and of q'' beside C psi''.
    T own_rate = wave * tempo * cos(argument) + 2 * drift * t + sweep * psi[f.d];
    T own_gamma = -wave * sin(argument) * argument_rate * argument_rate +
                  2 * product * psid[f.b] * psid[f.c] + 2 * drift + 2 * sweep * psid[f.d];
    T chained_rate(0);
    if (j > 0) {
      const T chain = f.chain.as<T>();
      value += chain * state.q[j - 1];
      chained_rate = chain * state.qd[j - 1];
      own_gamma += chain * state.gamma[j - 1];
    }
    T rate = own_rate + chained_rate;
    for (int i = 0; i < n(); ++i) rate += state.C(j, i) * psid[i];
    if (j > 0) state.C.row(j) += f.chain.as<T>() * state.C.row(j - 1);
    state.q[j] = value;
    state.qd[j] = rate;
    state.gamma[j] = own_gamma;
  }
  return state;
}

}  // namespace mixloop::oracle
