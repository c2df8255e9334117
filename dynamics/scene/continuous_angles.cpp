// SPDX-License-Identifier: MIT
#include "dynamics/scene/continuous_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "notation/functions/sincos.hpp"

namespace mixloop {
namespace {

using Op = Formula::Operator;

/// Marks, in a formula, what must not jump by whole turns: coordinates, and atan2s of its own.
class Counting {
 public:
  Counting(const Scene& scene, std::vector<bool>& counted) : symbols_(scene), counted_(counted) {}

  /// `value`: the node's value counts, not only its sine and cosine.
  void look(const Formula& formula, int index, bool value) {
    const Formula::Node& node = formula.nodes[static_cast<std::size_t>(index)];
    switch (node.op) {
      case Op::constant:
        return;
      case Op::symbol:
        if (value && symbols_.is_q(node.symbol))
          counted_[static_cast<std::size_t>(node.symbol - symbols_.q0)] = true;
        return;
      case Op::add:
      case Op::subtract:
        look(formula, node.left, value);
        look(formula, node.right, value);
        return;
      case Op::negate:
        look(formula, node.left, value);
        return;
      case Op::multiply:
        look(formula, node.left, value || !whole(formula, node.right));
        look(formula, node.right, value || !whole(formula, node.left));
        return;
      case Op::sin:
      case Op::cos:
      case Op::tan:
        look(formula, node.left, false);
        return;
      case Op::atan2:
        if (value) found_.push_back({.node = index});
        break;
      case Op::atan:
        if (has_pole(formula, node.left)) found_.push_back({.node = index, .of_quotient = true});
        break;
      default:
        break;
    }
    look(formula, node.left, true);
    if (node.right >= 0) look(formula, node.right, true);
  }

  /// Without what they stand in.
  const std::vector<CountedAngle>& found() const { return found_; }

 private:
  static bool whole(const Formula& formula, int index) {
    const Formula::Node& node = formula.nodes[static_cast<std::size_t>(index)];
    return node.op == Op::constant && node.value == std::round(node.value);
  }

  static bool has_pole(const Formula& formula, int index) {
    const Formula::Node& node = formula.nodes[static_cast<std::size_t>(index)];
    const auto constant = [&](int i) {
      return formula.nodes[static_cast<std::size_t>(i)].op == Op::constant;
    };
    if (node.op == Op::tan || (node.op == Op::divide && !constant(node.right)) ||
        (node.op == Op::power && node.exponent < 0))
      return true;
    return (node.left >= 0 && has_pole(formula, node.left)) ||
           (node.right >= 0 && has_pole(formula, node.right));
  }

  Symbols symbols_;
  std::vector<bool>& counted_;
  std::vector<CountedAngle> found_;
};

/// The slope of a transform's affine formula in its coordinate is a whole number.
bool turns_by_whole_multiples(const Formula& formula, int symbol) {
  const auto at = [&](double q) {
    return evaluate<double>(formula, [&](int s) { return s == symbol ? q : std::nan(""); });
  };
  const double slope = at(1) - at(0);  // not a number where a parameter stands in it
  return slope == std::round(slope);
}

/// The coordinates that something reads by value.
std::vector<bool> read_by_value(const Scene& scene) {
  std::vector<bool> counted(scene.coordinates.size(), false);
  for (const auto& load : scene.coordinate_loads) counted[static_cast<std::size_t>(load.coordinate)] = true;
  const Symbols symbols(scene);
  for (const auto& transform : scene.transforms)
    if (transform.coordinate &&
        (transform.prismatic ||
         !turns_by_whole_multiples(transform.theta, symbols.q0 + *transform.coordinate)))
      counted[static_cast<std::size_t>(*transform.coordinate)] = true;
  return counted;
}

double value_of(const Formula& formula, int node, const std::vector<double>& symbols) {
  return detail::evaluate_node<double>(formula, node,
                                       [&](int symbol) { return symbols[static_cast<std::size_t>(symbol)]; });
}

/// t, the parameters, psi and the coordinates that follow, in the order of Symbols.
std::vector<double> symbol_values(const Scene& scene, const std::vector<double>& parameters) {
  std::vector<double> values{0.0};
  values.insert(values.end(), parameters.begin(),
                parameters.begin() + static_cast<std::ptrdiff_t>(scene.parameters.size()));
  values.insert(values.end(), scene.home.begin(), scene.home.end());
  for (const auto& coordinate : scene.coordinates) values.push_back(coordinate.home);
  return values;
}

void follow(const Scene& scene, std::vector<double>& symbols) {
  const auto q0 = symbols.size() - scene.coordinates.size();
  for (const int j : scene.evaluation_order) {
    const Formula& constraint = scene.coordinates[static_cast<std::size_t>(j)].constraint;
    symbols[q0 + static_cast<std::size_t>(j)] =
        value_of(constraint, static_cast<int>(constraint.nodes.size()) - 1, symbols);
  }
}

/// A formula with some of its atan2(y, x) written as h + atan2(y cos h - x sin h, x cos h + y sin h).
class Turned {
 public:
  Turned(const Formula& formula, const std::vector<std::pair<int, double>>& turns)
      : from_(formula), turns_(turns) {
    made_.dimension = formula.dimension;
    made_.place = formula.place;
    copy(static_cast<int>(formula.nodes.size()) - 1);
    made_.height = height(static_cast<int>(made_.nodes.size()) - 1);
  }

  Formula take() { return std::move(made_); }

 private:
  int add(const Formula::Node& node) {
    made_.nodes.push_back(node);
    return static_cast<int>(made_.nodes.size()) - 1;
  }
  int constant(double value) { return add({.op = Op::constant, .value = value}); }
  int apply(Op op, int left, int right) { return add({.op = op, .left = left, .right = right}); }
  int times(int of, double factor) {
    const int left = copy(of);
    return apply(Op::multiply, left, constant(factor));
  }

  int copy(int index) {
    const Formula::Node& node = from_.nodes[static_cast<std::size_t>(index)];
    const auto turn =
        std::find_if(turns_.begin(), turns_.end(), [&](const auto& t) { return t.first == index; });
    if (turn != turns_.end()) return turned(node, turn->second);
    Formula::Node made = node;
    if (node.left >= 0) made.left = copy(node.left);
    if (node.right >= 0) made.right = copy(node.right);
    return add(made);
  }

  int turned(const Formula::Node& node, double h) {
    const int y_cos = times(node.left, mixloop_functions::cos(h)),
              x_sin = times(node.right, mixloop_functions::sin(h));
    const int y = apply(Op::subtract, y_cos, x_sin);
    const int x_cos = times(node.right, mixloop_functions::cos(h)),
              y_sin = times(node.left, mixloop_functions::sin(h));
    const int x = apply(Op::add, x_cos, y_sin);
    const int angle = apply(Op::atan2, y, x);
    return apply(Op::add, angle, constant(h));
  }

  int height(int index) const {
    const Formula::Node& node = made_.nodes[static_cast<std::size_t>(index)];
    int below = 0;
    for (const int operand : {node.left, node.right})
      if (operand >= 0) below = std::max(below, height(operand));
    return below + 1;
  }

  const Formula& from_;
  const std::vector<std::pair<int, double>>& turns_;
  Formula made_;
};

const Formula& formula_of(const Scene& scene, const CountedAngle& angle) {
  return angle.load < 0 ? scene.coordinates[static_cast<std::size_t>(angle.coordinate)].constraint
                        : scene.along_loads[static_cast<std::size_t>(angle.load)].along;
}

std::string what_has(const Scene& scene, const CountedAngle& angle) {
  return angle.load < 0
             ? "the coordinate '" + scene.coordinates[static_cast<std::size_t>(angle.coordinate)].name + "'"
             : "what a load acts along (line " + std::to_string(formula_of(scene, angle).place.line) + ")";
}

std::string jump_text(const std::string& what, bool of_quotient) {
  return what + " jumps by " +
         (of_quotient ? "half a turn where the divisor in its atan passes zero; expected the atan2 of the "
                        "two, which goes on"
                      : "a turn, half a turn away from its value at home: its atan2 gives no more than one, "
                        "and its value "
                        "counts (a load, a slide or a gear reads it); expected a motion within it");
}

}  // namespace

std::vector<CountedAngle> counted_angles(const Scene& scene) {
  std::vector<bool> counted = read_by_value(scene);
  std::vector<CountedAngle> angles;
  for (std::size_t i = 0; i < scene.along_loads.size(); ++i) {
    const Formula& along = scene.along_loads[i].along;
    Counting counting(scene, counted);
    counting.look(along, static_cast<int>(along.nodes.size()) - 1, true);
    for (CountedAngle angle : counting.found()) {
      angle.load = static_cast<int>(i);
      angles.push_back(angle);
    }
  }
  // Those that read others come before these.
  for (auto j = scene.evaluation_order.rbegin(); j != scene.evaluation_order.rend(); ++j) {
    const Formula& constraint = scene.coordinates[static_cast<std::size_t>(*j)].constraint;
    Counting counting(scene, counted);
    counting.look(constraint, static_cast<int>(constraint.nodes.size()) - 1,
                  counted[static_cast<std::size_t>(*j)]);
    for (CountedAngle angle : counting.found()) {
      angle.coordinate = *j;
      angles.push_back(angle);
    }
  }
  return angles;
}

void turn_cuts_away_from_home(Scene& scene) {
  const std::vector<CountedAngle> angles = counted_angles(scene);
  if (angles.empty()) return;
  std::vector<double> symbols = symbol_values(scene, scene.default_parameters());
  follow(scene, symbols);
  const auto turn = [&](Formula& formula, auto stands_in_it) {
    std::vector<std::pair<int, double>> turns;
    for (const auto& angle : angles)
      if (stands_in_it(angle) && !angle.of_quotient)
        if (const double h = value_of(formula, angle.node, symbols); std::isfinite(h) && h != 0)
          turns.emplace_back(angle.node, h);
    if (!turns.empty()) formula = Turned(formula, turns).take();
  };
  for (int j = 0; j < scene.m(); ++j)
    turn(scene.coordinates[static_cast<std::size_t>(j)].constraint,
         [&](const CountedAngle& angle) { return angle.load < 0 && angle.coordinate == j; });
  for (std::size_t i = 0; i < scene.along_loads.size(); ++i)
    turn(scene.along_loads[i].along,
         [&](const CountedAngle& angle) { return angle.load == static_cast<int>(i); });
}

AngleWatch::AngleWatch(const Scene& scene, std::vector<double> parameters)
    : scene_(scene), angles_(counted_angles(scene)), symbols_(symbol_values(scene, parameters)) {}

std::string AngleWatch::look(std::span<const double> psi, double t) {
  if (angles_.empty()) return {};
  symbols_[0] = t;
  const auto psi0 = symbols_.size() - scene_.coordinates.size() - scene_.independent.size();
  std::copy(psi.begin(), psi.end(), symbols_.begin() + static_cast<std::ptrdiff_t>(psi0));
  follow(scene_, symbols_);
  std::string jumped;
  std::vector<double> now;
  for (const CountedAngle& angle : angles_) {
    now.push_back(value_of(formula_of(scene_, angle), angle.node, symbols_));
    if (last_.empty() || !jumped.empty()) continue;
    const double by = std::abs(now.back() - last_[now.size() - 1]);
    if (by > std::numbers::pi / (angle.of_quotient ? 2 : 1))
      jumped = jump_text(what_has(scene_, angle), angle.of_quotient);
  }
  last_ = std::move(now);
  return jumped;
}

}  // namespace mixloop
