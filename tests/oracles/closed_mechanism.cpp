// SPDX-License-Identifier: MIT
#include "tests/oracles/closed_mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

namespace mixloop::oracle {

/// Draws whole numbers by the generator alone: the distributions of <random> differ between libraries.
class ClosedMechanism::Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  int below(int count) { return static_cast<int>(random_() % static_cast<std::uint64_t>(count)); }
  bool once_in(int count) { return below(count) == 0; }
  /// Between the two, in steps of 1/1024.
  double between(double low, double high) {
    const int first = static_cast<int>(low * 1024), last = static_cast<int>(high * 1024);
    return (first + below(last - first + 1)) / 1024.0;
  }
  double either_sign(double low, double high) { return (once_in(2) ? 1 : -1) * between(low, high); }
  std::array<double, 3> vector(double reach) {
    return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
  }

 private:
  std::mt19937_64 random_;
};

namespace {

/// All digits, in parentheses when negative.
std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, x < 0 ? "(%.17g)" : "%.17g", x);
  return text;
}

std::string digits(const std::array<double, 3>& x) {
  return "[\"" + digits(x[0]) + "\", \"" + digits(x[1]) + "\", \"" + digits(x[2]) + "\"]";
}

std::string numbered(const char* name, int i) { return name + std::to_string(i + 1); }

std::string frame_named(int frame) { return frame < 0 ? "0" : numbered("F", frame); }

VectorX<double> vector_of(const std::vector<double>& x) {
  return Eigen::Map<const VectorX<double>>(x.data(), static_cast<Eigen::Index>(x.size()));
}

constexpr double kMostCondition = 100;

}  // namespace

ClosedMechanism::ClosedMechanism(std::uint64_t seed) {
  Dice dice(seed);
  while (!draw(dice)) {
  }
}

bool ClosedMechanism::draw(Dice& dice) {
  coordinates_.clear(), frames_.clear(), bodies_.clear(), closures_.clear();
  independent_.clear(), psi_home_.clear(), guesses_.clear();
  planar_ = dice.once_in(2);
  draw_tree(dice);
  for (int k = 1 + dice.below(3); k > 0; --k)
    if (!draw_closure(dice)) return false;
  if (!choose_solved(dice)) return false;
  draw_gears(dice);
  return draw_state(dice);
}

void ClosedMechanism::draw_tree(Dice& dice) {
  const int count = 4 + dice.below(6);
  for (int j = 0; j < count; ++j) {
    Coordinate coordinate;
    coordinate.slides = dice.once_in(4);
    coordinate.pose = coordinate.slides ? dice.between(-1, 1) : dice.between(-3, 3);
    coordinates_.push_back(coordinate);
  }
  std::vector<int> ends{-1};
  const int gears = dice.below(3);
  for (int j = 0; j < count + gears; ++j) {
    Frame frame;
    frame.parent = dice.once_in(3) ? ends[static_cast<std::size_t>(dice.below(static_cast<int>(ends.size())))]
                                   : ends.back();
    // Each coordinate moves a frame; then some move another.
    frame.coordinate = j < count ? j : dice.below(count);
    frame.scale = j < count && dice.once_in(2) ? 1 : dice.either_sign(0.5, 2);
    const bool slides = coordinates_[static_cast<std::size_t>(frame.coordinate)].slides;
    if (planar_ && slides) {
      // Along a line of the plane.
      Frame turned;
      turned.parent = frame.parent;
      turned.theta = dice.between(-3, 3);
      turned.quarters = 1;
      frame.parent = static_cast<int>(frames_.size());
      frames_.push_back(turned);
      frame.quarters = -1;
    } else {
      frame.theta = dice.between(-3, 3);
      if (!planar_) frame.alpha = dice.between(-3, 3);
    }
    frame.s = dice.between(-0.5, 0.5);
    frame.a = planar_ && slides ? 0 : dice.between(-1, 1);
    frames_.push_back(frame);
    const int at = static_cast<int>(frames_.size()) - 1;
    ends.push_back(at);
    Body body{at, dice.between(0.5, 3), dice.vector(0.5), {}};
    for (std::size_t k = 0; k < 6; ++k)
      body.inertia[k] = k < 3 ? dice.between(0.5, 1) : dice.between(-0.125, 0.125);
    bodies_.push_back(body);
  }
  gravity_ = dice.vector(10);
}

int ClosedMechanism::parting(int a, int b) const {
  while (a != b) (a > b ? a : b) = frames_[static_cast<std::size_t>(std::max(a, b))].parent;
  return a;
}

int ClosedMechanism::coordinates_between(int a, int b) const {
  std::vector<bool> moves(coordinates_.size(), false);
  const int root = parting(a, b);
  for (int frame : {a, b})
    for (; frame != root; frame = frames_[static_cast<std::size_t>(frame)].parent)
      if (const int j = frames_[static_cast<std::size_t>(frame)].coordinate; j >= 0)
        moves[static_cast<std::size_t>(j)] = true;
  return static_cast<int>(std::count(moves.begin(), moves.end(), true));
}

bool ClosedMechanism::draw_closure(Dice& dice) {
  Closure closure;
  closure.kind = static_cast<Kind>(dice.below(5));
  // Frames with a body, and the ground.
  const auto frame = [&] {
    const int i = dice.below(static_cast<int>(bodies_.size()) + 1) - 1;
    return i < 0 ? -1 : bodies_[static_cast<std::size_t>(i)].frame;
  };
  for (int tries = 0; tries < 20; ++tries) {
    closure.frames = {frame(), frame()};
    if (closure.kind == Kind::zero || coordinates_between(closure.frames[0], closure.frames[1]) > 1)
      return place(closure, dice);
  }
  return false;
}

/// Chooses what is left free, then the rest so that it holds at the pose.
bool ClosedMechanism::place(Closure& closure, Dice& dice) {
  const VectorX<double> q = pose(), rest = VectorX<double>::Zero(m());
  const auto motions = frame_motions(tree<double>(), q, rest, rest);
  const auto motion = [&](int frame) {
    return frame < 0 ? FrameMotion<double>{} : motions[static_cast<std::size_t>(frame)];
  };
  const auto& one = motion(closure.frames[0]);
  const auto& two = motion(closure.frames[1]);
  const auto eigen = [](const std::array<double, 3>& x) { return Vector3<double>(x[0], x[1], x[2]); };
  const auto array = [](const Vector3<double>& x) { return std::array<double, 3>{x[0], x[1], x[2]}; };
  switch (closure.kind) {
    case Kind::coincide: {
      closure.vectors[1] = dice.vector(0.5);
      closure.vectors[0] = array(one.R.transpose() * (two.p + two.R * eigen(closure.vectors[1]) - one.p));
      closure.axes = {0, 1, 2};
      if (dice.once_in(3)) closure.axes.erase(closure.axes.begin() + dice.below(3));
      if (dice.once_in(4)) closure.in = dice.below(static_cast<int>(frames_.size()) + 1) - 1;
      break;
    }
    case Kind::distance: {
      closure.vectors = {dice.vector(0.5), dice.vector(0.5)};
      const double L =
          (two.p + two.R * eigen(closure.vectors[1]) - one.p - one.R * eigen(closure.vectors[0])).norm();
      if (L < 0.25) return false;
      closure.constant = L;
      if (dice.once_in(3)) closure.wave = dice.between(0.03125, 0.125), closure.tempo = dice.between(1, 3);
      if (dice.once_in(4)) {
        closure.along = dice.below(m());
        closure.slope = dice.either_sign(0.125, 0.5);
        closure.constant -= closure.slope * q[closure.along];
      }
      break;
    }
    case Kind::parallel: {
      closure.vectors[0] = dice.vector(1);
      if (planar_) closure.vectors[0][2] = 0;
      const Vector3<double> axis = eigen(closure.vectors[0]);
      if (axis.norm() < 0.25) return false;
      closure.vectors[1] = array((dice.once_in(2) ? 1 : -1) * (two.R.transpose() * (one.R * axis)));
      if (planar_) closure.vectors[1][2] = 0;
      break;
    }
    case Kind::align: {
      // Two frames more on the second one turn it to the first: Rz(t1) Rx(alpha) Rz(t2).
      const Matrix3<double> R = two.R.transpose() * one.R;
      Frame first, second;
      if (planar_) {
        first.theta = std::atan2(R(1, 0), R(0, 0));
      } else {
        first.theta = std::atan2(R(0, 2), -R(1, 2));
        first.alpha = std::acos(std::clamp(R(2, 2), -1.0, 1.0));
        second.theta = std::atan2(R(2, 0), R(2, 1));
      }
      first.parent = closure.frames[1];
      second.parent = static_cast<int>(frames_.size());
      frames_.push_back(first);
      frames_.push_back(second);
      closure.frames[1] = second.parent + 1;
      break;
    }
    case Kind::zero: {
      closure.along = dice.below(m());
      closure.other = dice.below(m());
      closure.turning = dice.below(m());
      const auto slides = [&](int j) { return coordinates_[static_cast<std::size_t>(j)].slides; };
      if (closure.along == closure.other || slides(closure.along) != slides(closure.other) ||
          slides(closure.turning))
        return false;
      closure.factor = dice.either_sign(0.5, 2);
      closure.other_factor = dice.either_sign(0.5, 2);
      if (!dice.once_in(4)) closure.wave = dice.between(-0.25, 0.25);
      closure.constant = closure.factor * q[closure.along] + closure.other_factor * q[closure.other] +
                         closure.wave * std::sin(q[closure.turning]);
      break;
    }
  }
  closures_.push_back(closure);
  return true;
}

VectorX<double> ClosedMechanism::pose() const {
  VectorX<double> q(m());
  for (int j = 0; j < m(); ++j) q[j] = coordinates_[static_cast<std::size_t>(j)].pose;
  return q;
}

/// The rows that don't follow from others, and as many coordinates that follow from them.
bool ClosedMechanism::choose_solved(Dice& dice) {
  for (Coordinate& coordinate : coordinates_) coordinate.solved = true;  // no formula yet
  const VectorX<double> q = pose();
  MatrixX<double> G =
      equations<double>(q, VectorX<double>::Zero(m()), VectorX<double>(), 0.0, true).G.leftCols(m());
  const Eigen::JacobiSVD<MatrixX<double>> svd(G);
  const auto& sizes = svd.singularValues();
  int rank = 0;
  for (Eigen::Index i = 0; i < sizes.size(); ++i) {
    if (sizes[i] > 1e-10 * sizes[0] && sizes[i] < 1e-3 * sizes[0]) return false;
    rank += sizes[i] >= 1e-3 * sizes[0] ? 1 : 0;
  }
  if (!(sizes[0] > 0) || rank >= m()) return false;
  // The first that say something new, as the loader takes them: of those that follow from others the numbers
  // are but doubles, so that they contradict in the last digits.
  MatrixX<double> basis(m(), 0);
  for (int i = 0; i < G.rows(); ++i) {
    VectorX<double> rest = G.row(i).transpose();
    for (int twice = 0; twice < 2; ++twice) rest -= basis * (basis.transpose() * rest).eval();
    if (!(rest.norm() > 1e-9 * G.row(i).norm()) || !(G.row(i).norm() > 1e-10)) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.col(basis.cols() - 1) = rest.normalized();
    independent_.push_back(i);
  }
  if (static_cast<int>(independent_.size()) != rank) return false;
  // What is driven in time would contradict a row that says the same.
  if (rank < G.rows())
    for (Closure& closure : closures_) closure.wave = closure.kind == Kind::distance ? 0 : closure.wave;
  MatrixX<double> rows(rank, m());
  for (int k = 0; k < rank; ++k) rows.row(k) = G.row(independent_[static_cast<std::size_t>(k)]);
  std::vector<int> order(static_cast<std::size_t>(m()));
  std::iota(order.begin(), order.end(), 0);
  for (int tries = 0; tries < 8; ++tries) {
    for (int j = m() - 1; j > 0; --j)
      std::swap(order[static_cast<std::size_t>(j)], order[static_cast<std::size_t>(dice.below(j + 1))]);
    MatrixX<double> square(rank, rank);
    for (int k = 0; k < rank; ++k) square.col(k) = rows.col(order[static_cast<std::size_t>(k)]);
    if (row_condition(square) < kMostCondition) {
      for (std::size_t j = 0; j < order.size(); ++j)
        coordinates_[static_cast<std::size_t>(order[j])].solved = static_cast<int>(j) < rank;
      return true;
    }
  }
  return false;
}

/// Each motor has a coordinate of its own; the others follow several, and some one that closures give.
void ClosedMechanism::draw_gears(Dice& dice) {
  std::vector<int> given, solved;
  for (int j = 0; j < m(); ++j)
    (coordinates_[static_cast<std::size_t>(j)].solved ? solved : given).push_back(j);
  const int motors = 1 + dice.below(std::min(4, static_cast<int>(given.size())));
  for (int i = 0; i < motors; ++i) psi_home_.push_back(dice.between(-1, 1));
  for (std::size_t k = 0; k < given.size(); ++k) {
    Coordinate& f = coordinates_[static_cast<std::size_t>(given[k])];
    f.linear.assign(static_cast<std::size_t>(motors), 0);
    const bool own = static_cast<int>(k) < motors;
    f.linear[own ? k : static_cast<std::size_t>(dice.below(motors))] = dice.either_sign(0.5, 2);
    if (!own) f.linear[static_cast<std::size_t>(dice.below(motors))] = dice.between(-0.5, 0.5);
    const int other = solved[static_cast<std::size_t>(dice.below(static_cast<int>(solved.size())))];
    if (dice.once_in(3) && coordinates_[static_cast<std::size_t>(other)].slides == f.slides)
      f.chained = other, f.chain = dice.either_sign(0.125, 0.5);
    f.offset = f.pose - (f.chained < 0 ? 0 : f.chain * coordinates_[static_cast<std::size_t>(other)].pose);
    for (std::size_t i = 0; i < f.linear.size(); ++i) f.offset -= f.linear[i] * psi_home_[i];
  }
  for (int j : solved)
    guesses_.push_back({j, coordinates_[static_cast<std::size_t>(j)].pose + dice.between(-0.1, 0.1)});
}

bool ClosedMechanism::draw_state(Dice& dice) {
  state_ = {};
  for (double psi : psi_home_) {
    state_.psi.push_back(psi + dice.between(-0.05, 0.05));
    state_.psid.push_back(dice.between(-1, 1));
    state_.input.push_back(dice.between(-5, 5));
  }
  state_.t = dice.between(0, 0.05);
  VectorX<double> q = pose();
  const VectorX<double> home = vector_of(psi_home_), psi = vector_of(state_.psi);
  if (!(condition(q, home, 0) <= kMostCondition)) return false;
  return follow<double>(q, home, psi, state_.t) && condition(q, psi, state_.t) <= kMostCondition;
}

double ClosedMechanism::row_condition(const MatrixX<double>& rows) const {
  MatrixX<double> scaled = rows;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) scaled.row(i) /= rows.row(i).norm();
  const Eigen::FullPivLU<MatrixX<double>> lu(scaled);
  if (!lu.isInvertible()) return HUGE_VAL;
  return scaled.norm() * lu.inverse().norm() / static_cast<double>(rows.rows());
}

double ClosedMechanism::condition(const VectorX<double>& q, const VectorX<double>& psi, double t) const {
  const auto e = equations<double>(q, VectorX<double>::Zero(m()), psi, t);
  const int solved = static_cast<int>(independent_.size()), given = m() - solved;
  // dq / d(solved): themselves, and what is geared to them.
  MatrixX<double> along = MatrixX<double>::Zero(m(), solved);
  int column = 0;
  for (int j = 0; j < m(); ++j) {
    if (!coordinates_[static_cast<std::size_t>(j)].solved) continue;
    along(j, column) = 1;
    for (int i = 0; i < m(); ++i)
      if (coordinates_[static_cast<std::size_t>(i)].chained == j)
        along(i, column) = coordinates_[static_cast<std::size_t>(i)].chain;
    ++column;
  }
  return row_condition(e.G.block(given, 0, solved, m()) * along);
}

std::string ClosedMechanism::scene_text() const {
  std::string text = "name: closed\nmotors: [", formulas;
  for (int i = 0; i < n(); ++i) text += (i ? ", " : "") + numbered("psi", i);
  text += "]\ncoordinates: [";
  for (int j = 0; j < m(); ++j) {
    text += (j ? ", " : "") + numbered("q", j);
    const Coordinate& f = coordinates_[static_cast<std::size_t>(j)];
    if (f.solved) continue;
    std::string sum = digits(f.offset);
    for (int i = 0; i < n(); ++i)
      if (f.linear[static_cast<std::size_t>(i)] != 0)
        sum += " + " + digits(f.linear[static_cast<std::size_t>(i)]) + " * " + numbered("psi", i);
    if (f.slides) sum = "(" + sum + ") * (1 m)";
    if (f.chained >= 0) sum += " + " + digits(f.chain) + " * " + numbered("q", f.chained);
    formulas += "  " + numbered("q", j) + ": \"" + sum + "\"\n";
  }
  text += "]\nconstraints:\n" + formulas + "transforms:\n";
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Frame& frame = frames_[i];
    std::string theta = digits(frame.theta), s = digits(frame.s), alpha = digits(frame.alpha);
    if (frame.coordinate >= 0)
      (coordinates_[static_cast<std::size_t>(frame.coordinate)].slides ? s : theta) +=
          " + " + digits(frame.scale) + " * " + numbered("q", frame.coordinate);
    if (frame.quarters != 0) alpha = frame.quarters > 0 ? "90 deg" : "-90 deg";
    text += "  - {from: " + frame_named(frame.parent) + ", to: " + frame_named(static_cast<int>(i)) +
            ", theta: \"" + theta + "\", s: \"" + s + "\", a: \"" + digits(frame.a) + "\", alpha: \"" +
            alpha + "\"}\n";
  }
  text += closures_text() + "bodies:\n";
  static const char* kElement[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
  for (const Body& body : bodies_) {
    text += "  - {frame: " + frame_named(body.frame) + ", mass: " + digits(body.mass) +
            ", center_of_mass: " + digits(body.centre) + ", inertia: {";
    for (std::size_t k = 0; k < 6; ++k)
      text += std::string(k ? ", " : "") + kElement[k] + ": \"" + digits(body.inertia[k]) + "\"";
    text += "}}\n";
  }
  text += "gravity: " + digits(gravity_) + "\nend_effector: {frame: " + frame_named(bodies_.back().frame) +
          ", point: [0.25, -0.5, 0.125]}\nhome: {";
  for (int i = 0; i < n(); ++i)
    text +=
        (i ? ", " : "") + numbered("psi", i) + ": \"" + digits(psi_home_[static_cast<std::size_t>(i)]) + "\"";
  for (const Guess& guess : guesses_)
    text += ", " + numbered("q", guess.coordinate) + ": \"" + digits(guess.value) + "\"";
  return text + "}\n";
}

std::string ClosedMechanism::closures_text() const {
  std::string text = "closures:\n";
  const auto end = [](const Closure& closure, std::size_t i, const char* key) {
    return "{frame: " + frame_named(closure.frames[i]) + ", " + key + ": " + digits(closure.vectors[i]) + "}";
  };
  const auto both = [&](const Closure& closure, const char* key) {
    return "[" + end(closure, 0, key) + ", " + end(closure, 1, key) + "]";
  };
  const auto wave_of = [](const Closure& closure, const std::string& argument) {
    return closure.wave == 0 ? "" : " + " + digits(closure.wave) + " * (1 m) * sin(" + argument + ")";
  };
  for (const Closure& closure : closures_) switch (closure.kind) {
      case Kind::coincide: {
        text += "  - {coincide: " + both(closure, "point") + ", axes: [";
        for (std::size_t k = 0; k < closure.axes.size(); ++k)
          text += std::string(k ? ", " : "") + "xyz"[closure.axes[k]];
        text += "]" + (closure.in == -2 ? "" : ", in: " + frame_named(closure.in)) + "}\n";
        break;
      }
      case Kind::distance: {
        std::string length =
            digits(closure.constant) + " * (1 m)" + wave_of(closure, digits(closure.tempo) + " * t / (1 s)");
        if (closure.along >= 0) {
          const bool slides = coordinates_[static_cast<std::size_t>(closure.along)].slides;
          length += " + " + digits(closure.slope) + " * " + numbered("q", closure.along) +
                    (slides ? "" : " * (1 m)");
        }
        text += "  - {distance: \"" + length + "\", between: " + both(closure, "point") + "}\n";
        break;
      }
      case Kind::parallel:
        text += "  - {parallel: " + both(closure, "axis") + "}\n";
        break;
      case Kind::align:
        text +=
            "  - {align: [" + frame_named(closure.frames[0]) + ", " + frame_named(closure.frames[1]) + "]}\n";
        break;
      case Kind::zero: {
        const bool slides = coordinates_[static_cast<std::size_t>(closure.along)].slides;
        std::string wave = wave_of(closure, numbered("q", closure.turning));
        if (!slides && !wave.empty()) wave.erase(wave.find(" * (1 m)"), 8);
        text += "  - {zero: \"" + digits(closure.factor) + " * " + numbered("q", closure.along) + " + " +
                digits(closure.other_factor) + " * " + numbered("q", closure.other) + wave + " - " +
                digits(closure.constant) + (slides ? " * (1 m)" : "") + "\"}\n";
        break;
      }
    }
  return text;
}

}  // namespace mixloop::oracle
