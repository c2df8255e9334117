// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include "dynamics/procedure/matrix.hpp"
#include "dynamics/procedure/taylor.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// How the axis of a link stands to that of the one before, as far as its constant alpha says so.
enum class Twist : std::uint8_t {
  none,  ///< the same
  half,  ///< against it
  other
};

/// A scene with its numbers worked out, for given parameter values, on the scalar T. Constant once made.
template <class T>
struct Model {
  /// A transform whose varying parameter is scale * q + offset.
  struct Link {
    int parent = 0;
    int coordinate = -1;  ///< -1: fixed
    bool prismatic = false;
    T scale{1};
    T theta{0}, s{0}, a{0};        ///< of the varying one, the offset
    T cos_theta{1}, sin_theta{0};  ///< where theta doesn't vary
    T cos_alpha{1}, sin_alpha{0};
    Twist twist = Twist::other;
    std::vector<int> path;  ///< coordinates that move this frame, ascending
  };
  struct Body {
    int frame = 0;
    T mass{0};
    Vec3<T> center_of_mass;
    Mat3<T> inertia;
  };
  struct Load {
    int frame = 0;
    Vec3<T> point;
  };
  struct CoordinateLoad {
    int coordinate = 0;
    T stiffness{0}, rest{0}, damping{0};
  };
  struct Closure {
    std::array<Vec3<T>, 2> vectors;  ///< points, or axes of length 1
    std::array<Vec3<T>, 2> across;   ///< of parallel: perpendicular to the first axis and to each other
  };

  struct SpringDamper {
    T stiffness{0}, rest{0}, damping{0};
  };
  struct AlongLoad {
    SpringDamper law;
    std::vector<int> names;  ///< the symbols that vary in its formula: t, psi and q, ascending
  };
  struct BetweenLoad {
    SpringDamper law;
    bool stretches = false;                 ///< a spring with a rest: it needs the length
    bool damps = false;                     ///< it needs the length's rate
    std::array<Vec3<T>, 2> point;           ///< in the ends' own frames
    std::array<std::vector<int>, 2> chain;  ///< links from each end's frame down to where the two part
  };

  std::shared_ptr<const Scene> scene;
  std::vector<T> parameters;
  std::vector<Link> links;  ///< link i makes frame i + 1
  std::vector<Body> bodies;
  std::vector<Load> loads;
  std::vector<CoordinateLoad> coordinate_loads;
  std::vector<Closure> closures;
  std::vector<AlongLoad> along_loads;
  std::vector<BetweenLoad> between_loads;
  Vec3<T> gravity;
  Vec3<T> end_effector_point;

  int n() const { return scene->n(); }
  int n_u() const { return scene->n_u(); }
  int m() const { return scene->m(); }
  /// The coordinates that move a frame.
  const std::vector<int>& path(int frame) const {
    static const std::vector<int> none;
    return frame == 0 ? none : links[static_cast<std::size_t>(frame - 1)].path;
  }
};

namespace detail {

/// cos or sin (`quarter` = 0 or 1 turns back) of a constant angle, exact at multiples of 90 degrees:
/// 90 deg is a right angle although pi/2 is no double.
template <class T>
void constant_cos_sin(double angle, T& cosine, T& sine) {
  using mixloop_functions::cos, mixloop_functions::sin;
  const double quarters = angle / (std::numbers::pi / 2);
  const double nearest = std::round(quarters);
  if (std::abs(quarters - nearest) <= 4e-16 * std::max(1.0, std::abs(nearest)) && std::abs(nearest) < 1e6) {
    static constexpr int kCosine[] = {1, 0, -1, 0};
    const int turn = static_cast<int>(((static_cast<long>(nearest) % 4) + 4) % 4);
    cosine = T(kCosine[turn]);
    sine = T(kCosine[(turn + 3) % 4]);
    return;
  }
  cosine = cos(T(angle));
  sine = sin(T(angle));
}

inline Twist twist_of(double alpha) {
  double cosine = 0, sine = 0;
  constant_cos_sin(alpha, cosine, sine);
  return sine != 0 ? Twist::other : cosine > 0 ? Twist::none : Twist::half;
}

/// v of length 1. Along an axis it is so already, to the bit.
template <class T>
Vec3<T> unit(const Vec3<T>& v) {
  using std::sqrt;
  return v * T(T(1) / sqrt(T(v.dot(v))));
}

/// Two vectors perpendicular to `axis`, of length 1, and to each other; `least` is where it points least.
template <class T>
std::array<Vec3<T>, 2> across(const Vec3<T>& axis, int least) {
  const int i = (least + 1) % 3, j = (least + 2) % 3;
  Vec3<T> one;
  one[least] = T(0);
  one[i] = axis[j];
  one[j] = -axis[i];
  one = unit<T>(one);
  const Vec3<T> two{axis[1] * one[2] - axis[2] * one[1], axis[2] * one[0] - axis[0] * one[2],
                    axis[0] * one[1] - axis[1] * one[0]};
  return {one, two};
}

/// The symbols of a formula that vary, each once.
inline std::vector<int> varying_names(const Formula& formula, const Symbols& symbols) {
  std::set<int> names;
  for (const auto& node : formula.nodes)
    if (node.op == Formula::Operator::symbol && !symbols.is_parameter(node.symbol)) names.insert(node.symbol);
  return {names.begin(), names.end()};
}

/// Of two frames, the links from each down to where their chains part.
inline std::array<std::vector<int>, 2> parted_chains(const Scene& scene, int one, int other) {
  std::array<std::vector<int>, 2> chains;
  while (one != other) {
    const bool first = one > other;  // parents come first
    int& outer = first ? one : other;
    chains[first ? 0 : 1].push_back(outer - 1);
    outer = scene.transforms[static_cast<std::size_t>(outer - 1)].parent;
  }
  return chains;
}

}  // namespace detail

/// The model of `scene` at these parameter values (as its default_parameters()).
/// The scene has been checked for its defaults; check_physical does so for others.
template <class T>
Model<T> make_model(const std::shared_ptr<const Scene>& scene, std::span<const T> parameters) {
  using mixloop_functions::cos, mixloop_functions::sin;
  const Symbols symbols(*scene);
  Model<T> model;
  model.scene = scene;
  model.parameters.assign(parameters.begin(), parameters.end());
  const auto number = [&](const Formula& formula) {
    return evaluate<T>(formula, [&](int symbol) {
      return parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)];
    });
  };
  const auto vector = [&](const std::array<Formula, 3>& formulas) -> Vec3<T> {
    return Vec3<T>(number(formulas[0]), number(formulas[1]), number(formulas[2]));
  };
  // An affine formula of a coordinate: v = its value at q = 0, d = its slope.
  const auto affine = [&](const Formula& formula, int coordinate) {
    return evaluate<Taylor<T>>(formula, [&](int symbol) {
      if (symbols.is_parameter(symbol))
        return Taylor<T>(parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)]);
      return Taylor<T>(T(0), T(symbol == symbols.q0 + coordinate ? 1 : 0), T(0));
    });
  };

  for (const auto& transform : scene->transforms) {
    typename Model<T>::Link link;
    link.parent = transform.parent;
    link.coordinate = transform.coordinate.value_or(-1);
    link.prismatic = transform.prismatic;
    const Taylor<T> theta = affine(transform.theta, link.coordinate),
                    s = affine(transform.s, link.coordinate);
    link.theta = theta.v;
    link.s = s.v;
    if (link.coordinate >= 0) link.scale = link.prismatic ? s.d : theta.d;
    link.a = number(transform.a);
    const auto cos_sin = [&](const Formula& formula, const T& angle, T& cosine, T& sine) {
      if (formula.is_constant()) return detail::constant_cos_sin(formula.constant(), cosine, sine);
      cosine = cos(angle);
      sine = sin(angle);
    };
    cos_sin(transform.alpha, number(transform.alpha), link.cos_alpha, link.sin_alpha);
    if (transform.alpha.is_constant()) link.twist = detail::twist_of(transform.alpha.constant());
    if (link.coordinate < 0 || link.prismatic)
      cos_sin(transform.theta, link.theta, link.cos_theta, link.sin_theta);
    link.path = model.path(link.parent);
    if (link.coordinate >= 0 &&
        std::find(link.path.begin(), link.path.end(), link.coordinate) == link.path.end())
      link.path.insert(std::upper_bound(link.path.begin(), link.path.end(), link.coordinate),
                       link.coordinate);
    model.links.push_back(std::move(link));
  }
  for (const auto& body : scene->bodies) {
    typename Model<T>::Body made;
    made.frame = body.frame;
    made.mass = number(body.mass);
    made.center_of_mass = vector(body.center_of_mass);
    const auto I = [&](std::size_t i) { return number(body.inertia[i]); };
    made.inertia << I(0), I(3), I(4), I(3), I(1), I(5), I(4), I(5), I(2);
    model.bodies.push_back(std::move(made));
  }
  for (const auto& load : scene->loads) model.loads.push_back({load.frame, vector(load.point)});
  for (const auto& load : scene->coordinate_loads) {
    T damping = number(load.damping);
    if (scene->friction_factor) damping *= parameters[scene->parameters.size()];
    model.coordinate_loads.push_back({load.coordinate, number(load.stiffness), number(load.rest), damping});
  }
  for (const auto& closure : scene->closures) {
    typename Model<T>::Closure made;
    const bool of_axes = closure.kind == Scene::Closure::Kind::parallel;
    for (std::size_t i = 0; i < 2; ++i)
      if (of_axes)
        made.vectors[i] = detail::unit<T>(vector(closure.vectors[i]));
      else if (closure.has_points())
        made.vectors[i] = vector(closure.vectors[i]);
    if (of_axes) made.across = detail::across<T>(made.vectors[0], closure.least_axis);
    model.closures.push_back(std::move(made));
  }
  const auto law = [&](const Scene::SpringDamper& said) {
    T damping = number(said.damping);
    if (scene->friction_factor) damping *= parameters[scene->parameters.size()];
    return typename Model<T>::SpringDamper{number(said.stiffness), number(said.rest), damping};
  };
  for (const auto& load : scene->along_loads)
    model.along_loads.push_back({law(load.law), detail::varying_names(load.along, symbols)});
  for (const auto& load : scene->between_loads)
    model.between_loads.push_back(
        {.law = law(load.law),
         .stretches = !load.law.stiffness.is_zero() && !load.law.rest.is_zero(),
         .damps = !load.law.damping.is_zero(),
         .point = {vector(load.ends[0].point), vector(load.ends[1].point)},
         .chain = detail::parted_chains(*scene, load.ends[0].frame, load.ends[1].frame)});
  model.gravity = vector(scene->gravity);
  model.end_effector_point = vector(scene->end_effector.point);
  return model;
}

// Compiled once for double, in procedure.cpp.
extern template Model<double> make_model(const std::shared_ptr<const Scene>&, std::span<const double>);

}  // namespace mixloop
