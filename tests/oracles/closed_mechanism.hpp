// SPDX-License-Identifier: MIT
// Seeded random mechanisms whose chains close, told twice: as a scene's text for the loader, and as a tree
// with equations between its coordinates, whose rates are vectors worked out by hand here. First the tree and
// a pose are drawn, then closures that hold there; then which coordinates follow from them, and what gears
// hold the others to the motors.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/oracles/multipliers.hpp"

namespace mixloop::oracle {

/// What the equations between coordinates (m, then the motors' n) are at one instant: their values, and
/// G x'' = gamma. The rates obey G x' = -by_time.
template <class T>
struct EquationsBetween {
  VectorX<T> value, by_time, gamma;
  MatrixX<T> G;
};

class ClosedMechanism {
 public:
  /// Drawn again and again until it has a freedom, up to four, and a condition up to 100 at its pose and at
  /// the state that it is looked at in.
  explicit ClosedMechanism(std::uint64_t seed);

  int n() const { return static_cast<int>(psi_home_.size()); }
  int m() const { return static_cast<int>(coordinates_.size()); }
  bool is_planar() const { return planar_; }
  /// The scene, as a file of docs/scenes.md's format. Its guess is off the pose by up to 0.1.
  std::string scene_text() const;
  /// What is guessed of the coordinates that closures give; of the others nothing.
  struct Guess {
    int coordinate;
    double value;
  };
  const std::vector<Guess>& guesses() const { return guesses_; }

  /// Near the pose, to look at: psi, psi', tau or psi'', t.
  struct State {
    std::vector<double> psi, psid, input;
    double t = 0;
  };
  const State& state() const { return state_; }
  const std::vector<double>& home_psi() const { return psi_home_; }
  /// The pose that was drawn: of all coordinates.
  VectorX<double> pose() const;

  template <class T>
  Tree<T> tree() const;
  /// All formulas, and those rows of the closures that don't follow from others; or all rows.
  template <class T>
  EquationsBetween<T> equations(const VectorX<T>& q, const VectorX<T>& qd, const VectorX<T>& psi, const T& t,
                                bool all = false) const;
  /// Newton's method from q, by all equations at once. False where it doesn't find an end.
  template <class T>
  bool close(VectorX<T>& q, const VectorX<T>& psi, const T& t) const;
  /// The same at the end of the straight line from `psi_from` and time 0, where q closes.
  template <class T>
  bool follow(VectorX<T>& q, const VectorX<T>& psi_from, const VectorX<T>& psi, const T& t) const;
  /// Where q closes: C, q' and the part of q'' that psi'' has no share in.
  template <class T>
  ConstraintState<T> rates(const VectorX<T>& q, const VectorX<T>& psi, const VectorX<T>& psid,
                           const T& t) const;
  /// (q'', psi'', multipliers) with all equations kept, at the motors' tau.
  template <class T>
  MultiplierSolution<T> forward_dynamics(const ConstraintState<T>& state, const VectorX<T>& psi,
                                         const VectorX<T>& tau, const T& t) const;
  /// |G|_F |G^-1|_F / k of the closures by the coordinates that follow from them.
  double condition(const VectorX<double>& q, const VectorX<double>& psi, double t) const;

 private:
  class Dice;
  struct Coordinate {
    bool slides = false, solved = false;
    double pose = 0;
    // Otherwise offset + sum_i linear_i psi_i + chain q_solved
    double offset = 0, chain = 0;
    int chained = -1;
    std::vector<double> linear;
  };
  struct Frame {
    int parent = -1, coordinate = -1;
    double theta = 0, s = 0, a = 0, alpha = 0, scale = 1;
    int quarters = 0;  // of a turn, added to alpha
  };
  struct Body {
    int frame;
    double mass;
    std::array<double, 3> centre;
    std::array<double, 6> inertia;  // xx yy zz xy xz yz
  };
  enum class Kind { coincide, distance, parallel, align, zero };
  struct Closure {
    Kind kind = Kind::coincide;
    std::array<int, 2> frames{-1, -1};
    std::array<std::array<double, 3>, 2> vectors{};
    std::vector<int> axes;
    int in = -2;  // -2: where the chains part
    // A length constant + wave sin(tempo t) + slope q_along; or zero is
    // factor q_along + other_factor q_other + wave sin(q_turning) - constant.
    double constant = 0, wave = 0, tempo = 0, slope = 0, factor = 0, other_factor = 0;
    int along = -1, other = -1, turning = -1;
  };
  /// A quantity and its first two rates.
  template <class T>
  struct Going {
    T value{}, rate{}, second{};
  };
  template <class T>
  using Going3 = std::array<Vector3<T>, 3>;

  bool draw(Dice& dice);
  void draw_tree(Dice& dice);
  bool draw_closure(Dice& dice);
  bool place(Closure& closure, Dice& dice);
  bool choose_solved(Dice& dice);
  void draw_gears(Dice& dice);
  bool draw_state(Dice& dice);

  int parting(int a, int b) const;
  int coordinates_between(int a, int b) const;
  double row_condition(const MatrixX<double>& rows) const;
  template <class T>
  void rows_of(const Closure& closure, const std::vector<FrameMotion<T>>& motions, const VectorX<T>& q,
               const VectorX<T>& qd, const VectorX<T>& qdd, const T& t, std::vector<Going<T>>& rows) const;
  template <class T>
  std::vector<Going<T>> all_rows(const VectorX<T>& q, const VectorX<T>& qd, const VectorX<T>& qdd,
                                 const T& t) const;
  std::string closures_text() const;

  bool planar_ = false;
  std::vector<Coordinate> coordinates_;
  std::vector<Frame> frames_;
  std::vector<Body> bodies_;
  std::vector<Closure> closures_;
  std::vector<int> independent_;  // of the closures' rows
  std::vector<double> psi_home_;
  std::vector<Guess> guesses_;
  std::array<double, 3> gravity_{};
  State state_;
};

template <class T>
Tree<T> ClosedMechanism::tree() const {
  using std::asin;
  const auto vector = [](const std::array<double, 3>& x) { return Vector3<T>(T(x[0]), T(x[1]), T(x[2])); };
  Tree<T> tree;
  tree.coordinates = m();
  tree.gravity = vector(gravity_);
  for (const Frame& frame : frames_) {
    const Motion motion = frame.coordinate < 0 ? Motion::fixed
                          : coordinates_[static_cast<std::size_t>(frame.coordinate)].slides
                              ? Motion::prismatic
                              : Motion::revolute;
    tree.frames.push_back({frame.parent, T(frame.theta), T(frame.s), T(frame.a),
                           T(T(frame.alpha) + T(frame.quarters) * asin(T(1))), motion, frame.coordinate,
                           T(frame.scale)});
  }
  for (const Body& body : bodies_) {
    const auto I = [&](std::size_t k) { return T(body.inertia[k]); };
    Matrix3<T> inertia;
    inertia << I(0), I(3), I(4), I(3), I(1), I(5), I(4), I(5), I(2);
    tree.bodies.push_back({body.frame, T(body.mass), vector(body.centre), inertia});
  }
  return tree;
}

namespace closed_mechanism {

template <class T>
using Going3 = std::array<Vector3<T>, 3>;

/// A point of a frame, and a vector that is fixed in it, with two rates.
template <class T>
Going3<T> point_of(const FrameMotion<T>& m, const std::array<double, 3>& at) {
  const Vector3<T> r = m.R * Vector3<T>(T(at[0]), T(at[1]), T(at[2]));
  return {Vector3<T>(m.p + r), Vector3<T>(m.v + m.w.cross(r)), m.acceleration_of(r)};
}

template <class T>
Going3<T> vector_of(const FrameMotion<T>& m, const Vector3<T>& fixed) {
  const Vector3<T> r = m.R * fixed;
  return {r, Vector3<T>(m.w.cross(r)), Vector3<T>(m.w_rate.cross(r) + m.w.cross(m.w.cross(r)))};
}

}  // namespace closed_mechanism

template <class T>
void ClosedMechanism::rows_of(const Closure& closure, const std::vector<FrameMotion<T>>& motions,
                              const VectorX<T>& q, const VectorX<T>& qd, const VectorX<T>& qdd, const T& t,
                              std::vector<Going<T>>& rows) const {
  using closed_mechanism::point_of, closed_mechanism::vector_of;
  using std::cos;
  using std::sin;
  const auto motion = [&](int frame) {
    return frame < 0 ? FrameMotion<T>{} : motions[static_cast<std::size_t>(frame)];
  };
  const auto dot = [](const Going3<T>& a, const Going3<T>& b) {
    return Going<T>{a[0].dot(b[0]), T(a[1].dot(b[0]) + a[0].dot(b[1])),
                    T(a[2].dot(b[0]) + 2 * a[1].dot(b[1]) + a[0].dot(b[2]))};
  };
  const FrameMotion<T> one = motion(closure.frames[0]), two = motion(closure.frames[1]);
  const auto apart = [&] {
    const auto p1 = point_of(one, closure.vectors[0]), p2 = point_of(two, closure.vectors[1]);
    Going3<T> r;
    for (std::size_t k = 0; k < 3; ++k) r[k] = p2[k] - p1[k];
    return r;
  };
  const auto unit = [](int axis) { return Vector3<T>(Vector3<T>::Unit(axis)); };
  const auto difference = [](const Going<T>& a, const Going<T>& b) {
    return Going<T>{T(a.value - b.value), T(a.rate - b.rate), T(a.second - b.second)};
  };
  switch (closure.kind) {
    case Kind::coincide: {
      const FrameMotion<T> in =
          motion(closure.in == -2 ? parting(closure.frames[0], closure.frames[1]) : closure.in);
      for (int axis : closure.axes) rows.push_back(dot(vector_of(in, unit(axis)), apart()));
      break;
    }
    case Kind::distance: {
      const auto r = apart();
      const Going<T> square = dot(r, r);
      const T w(closure.tempo), A(closure.wave);
      Going<T> L{T(T(closure.constant) + A * sin(T(w * t))), T(A * w * cos(T(w * t))),
                 T(-A * w * w * sin(T(w * t)))};
      if (closure.along >= 0) {
        const T slope(closure.slope);
        L.value += slope * q[closure.along];
        L.rate += slope * qd[closure.along];
        L.second += slope * qdd[closure.along];
      }
      rows.push_back({T((square.value - L.value * L.value) / 2), T(square.rate / 2 - L.value * L.rate),
                      T(square.second / 2 - L.rate * L.rate - L.value * L.second)});
      break;
    }
    case Kind::parallel: {
      const Vector3<T> axis(T(closure.vectors[0][0]), T(closure.vectors[0][1]), T(closure.vectors[0][2]));
      int least = 0;
      for (int k = 1; k < 3; ++k)
        if (std::abs(closure.vectors[0][static_cast<std::size_t>(k)]) <
            std::abs(closure.vectors[0][static_cast<std::size_t>(least)]))
          least = k;
      const Vector3<T> across = axis.cross(unit(least)), other = axis.cross(across);
      const auto second = vector_of(
          two, Vector3<T>(T(closure.vectors[1][0]), T(closure.vectors[1][1]), T(closure.vectors[1][2])));
      rows.push_back(dot(vector_of(one, across), second));
      rows.push_back(dot(vector_of(one, other), second));
      break;
    }
    case Kind::align: {
      const auto R = [&](int i, int j) { return dot(vector_of(one, unit(i)), vector_of(two, unit(j))); };
      rows.push_back(difference(R(2, 1), R(1, 2)));
      rows.push_back(difference(R(0, 2), R(2, 0)));
      rows.push_back(difference(R(1, 0), R(0, 1)));
      break;
    }
    case Kind::zero: {
      const T f(closure.factor), g(closure.other_factor), A(closure.wave);
      const int i = closure.along, j = closure.other, k = closure.turning;
      const T c = cos(q[k]), s = sin(q[k]);
      rows.push_back({T(f * q[i] + g * q[j] + A * s - T(closure.constant)),
                      T(f * qd[i] + g * qd[j] + A * c * qd[k]),
                      T(f * qdd[i] + g * qdd[j] + A * (c * qdd[k] - s * qd[k] * qd[k]))});
      break;
    }
  }
}

template <class T>
auto ClosedMechanism::all_rows(const VectorX<T>& q, const VectorX<T>& qd, const VectorX<T>& qdd,
                               const T& t) const -> std::vector<Going<T>> {
  const auto motions = frame_motions(tree<T>(), q, qd, qdd);
  std::vector<Going<T>> rows;
  for (const Closure& closure : closures_) rows_of(closure, motions, q, qd, qdd, t, rows);
  return rows;
}

template <class T>
EquationsBetween<T> ClosedMechanism::equations(const VectorX<T>& q, const VectorX<T>& qd,
                                               const VectorX<T>& psi, const T& t, bool all) const {
  const VectorX<T> none = VectorX<T>::Zero(m());
  const auto rows = all_rows<T>(q, qd, none, t), still = all_rows<T>(q, none, none, t);
  std::vector<int> chosen = independent_;
  if (all) {
    chosen.clear();
    for (std::size_t i = 0; i < rows.size(); ++i) chosen.push_back(static_cast<int>(i));
  }
  int given = 0;
  for (const Coordinate& coordinate : coordinates_) given += coordinate.solved ? 0 : 1;
  const int count = given + static_cast<int>(chosen.size());
  EquationsBetween<T> e{VectorX<T>::Zero(count), VectorX<T>::Zero(count), VectorX<T>::Zero(count),
                        MatrixX<T>::Zero(count, m() + n())};
  int at = 0;
  for (int j = 0; j < m(); ++j) {
    const Coordinate& f = coordinates_[static_cast<std::size_t>(j)];
    if (f.solved) continue;
    e.value[at] = q[j] - T(f.offset);
    e.G(at, j) = T(1);
    for (int i = 0; i < n(); ++i) {
      e.value[at] -= T(f.linear[static_cast<std::size_t>(i)]) * psi[i];
      e.G(at, m() + i) = -T(f.linear[static_cast<std::size_t>(i)]);
    }
    if (f.chained >= 0) {
      e.value[at] -= T(f.chain) * q[f.chained];
      e.G(at, f.chained) -= T(f.chain);
    }
    ++at;
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto& row = rows[static_cast<std::size_t>(chosen[k])];
    const auto to = at + static_cast<Eigen::Index>(k);
    e.value[to] = row.value;
    e.by_time[to] = still[static_cast<std::size_t>(chosen[k])].rate;
    e.gamma[to] = -row.second;
  }
  for (int j = 0; j < m(); ++j) {
    const auto along = all_rows<T>(q, VectorX<T>(VectorX<T>::Unit(m(), j)), none, t);
    for (std::size_t k = 0; k < chosen.size(); ++k)
      e.G(at + static_cast<Eigen::Index>(k), j) =
          along[static_cast<std::size_t>(chosen[k])].rate - still[static_cast<std::size_t>(chosen[k])].rate;
  }
  return e;
}

template <class T>
bool ClosedMechanism::close(VectorX<T>& q, const VectorX<T>& psi, const T& t) const {
  const VectorX<T> rest = VectorX<T>::Zero(m());
  const T enough = std::numeric_limits<T>::epsilon() * 1000;
  for (int i = 0; i < 30; ++i) {
    const auto e = equations<T>(q, rest, psi, t);
    const VectorX<T> by = Eigen::PartialPivLU<MatrixX<T>>(e.G.leftCols(m())).solve(e.value);
    q -= by;
    const T moved = by.cwiseAbs().maxCoeff();
    if (!(moved < T(3))) return false;
    if (moved < enough) return true;
  }
  return false;
}

template <class T>
bool ClosedMechanism::follow(VectorX<T>& q, const VectorX<T>& psi_from, const VectorX<T>& psi,
                             const T& t) const {
  constexpr int kSteps = 8;
  for (int k = 1; k <= kSteps; ++k)
    if (!close<T>(q, VectorX<T>(psi_from + (psi - psi_from) * T(k) / T(kSteps)), T(t * k / kSteps)))
      return false;
  return true;
}

template <class T>
ConstraintState<T> ClosedMechanism::rates(const VectorX<T>& q, const VectorX<T>& psi, const VectorX<T>& psid,
                                          const T& t) const {
  const VectorX<T> rest = VectorX<T>::Zero(m());
  const auto still = equations<T>(q, rest, psi, t);
  const Eigen::PartialPivLU<MatrixX<T>> G_q(still.G.leftCols(m()));
  ConstraintState<T> state;
  state.q = q;
  state.C = G_q.solve(MatrixX<T>(-still.G.rightCols(n())));
  state.qd = state.C * psid - G_q.solve(still.by_time);
  state.gamma = G_q.solve(equations<T>(q, state.qd, psi, t).gamma);
  return state;
}

template <class T>
MultiplierSolution<T> ClosedMechanism::forward_dynamics(const ConstraintState<T>& state,
                                                        const VectorX<T>& psi, const VectorX<T>& tau,
                                                        const T& t) const {
  const auto e = equations<T>(state.q, state.qd, psi, t);
  const auto whole = tree<T>();
  MatrixX<T> M = MatrixX<T>::Zero(m() + n(), m() + n());
  M.topLeftCorner(m(), m()) = tree_mass_matrix(whole, state.q);
  VectorX<T> force(m() + n());
  force << -tree_bias(whole, state.q, state.qd), tau;
  const VectorX<T> x = augmented_solve<T>(M, e.G, force, e.gamma);
  return {x.head(m()), x.segment(m(), n()), x.tail(x.size() - m() - n())};
}

}  // namespace mixloop::oracle
