// SPDX-License-Identifier: MIT
// Composite rigid bodies and Newton-Euler along the tree (Featherstone, Rigid Body Dynamics Algorithms,
// ch. 5 and 6), in link frames; then C, as (31) and (32).
//
// A transform turns about z by theta into the frame "mid", where the way to the next origin is
// (a, 0, s) whatever the angle is, then about x by the constant alpha.
#include "dynamics/procedure/bodies.hpp"
#include "dynamics/procedure/constraints.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {
namespace {

using E = Expression;
using V3 = Vec3<E>;
using M3 = Mat3<E>;

V3 cross(const V3& a, const V3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

V3 zero() { return {E(0.0), E(0.0), E(0.0)}; }

// A rotation about one axis, by its cosine and sine.
struct Turn {
  E c, s;

  V3 into_z(const V3& x) const { return {c * x[0] + s * x[1], c * x[1] - s * x[0], x[2]}; }
  V3 back_z(const V3& x) const { return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]}; }
  V3 into_x(const V3& x) const { return {x[0], c * x[1] + s * x[2], c * x[2] - s * x[1]}; }
  V3 back_x(const V3& x) const { return {x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]}; }

  // R I R^T of a symmetric I, column by column and row by row.
  M3 back_x(const M3& I) const { return both(I, [&](const V3& x) { return back_x(x); }); }
  M3 back_z(const M3& I) const { return both(I, [&](const V3& x) { return back_z(x); }); }

 private:
  template <class Rotate>
  static M3 both(const M3& I, Rotate rotate) {
    M3 half, whole;
    for (Eigen::Index j = 0; j < 3; ++j) half.col(j) = rotate(V3(I.col(j)));
    for (Eigen::Index i = 0; i < 3; ++i) whole.row(i) = rotate(V3(half.row(i).transpose())).transpose();
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < i; ++j) whole(i, j) = whole(j, i);
    return whole;
  }
};

// Mass, first moment and inertia of a rigid body about a frame's origin, in its axes.
struct Inertia {
  E mass = 0.0;
  V3 moment = zero();
  M3 tensor = M3::Constant(E(0.0));

  Inertia& operator+=(const Inertia& other) {
    mass += other.mass;
    moment += other.moment;
    tensor += other.tensor;
    return *this;
  }
};

// |a.b| E - sym: the tensor that a mass at r brings is m (r.r E - r r^T).
M3 parallel_axis(const V3& r, const V3& moment) {
  M3 T;
  const E trace = r.dot(moment);
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) T(i, j) = (i == j ? trace : E(0.0)) - r[i] * moment[j];
  return T;
}

struct Wrench {
  V3 force = zero(), moment = zero();
};

struct Motion {
  V3 w = zero(), alpha = zero(), a = zero();
};

class RecursiveTracer final : public Tracer {
 public:
  explicit RecursiveTracer(std::shared_ptr<const Scene> scene)
      : in_(*scene), model_(make_model<E>(scene, std::span<const E>(in_.parameters))), workspace_(model_) {
    coordinates<E>(model_, span_of(in_.psi), in_.t, workspace_);
    C_ = workspace_.C;
    coordinate_rates<E>(model_, span_of(in_.psi), span_of(in_.psid), in_.t, workspace_);
    place_links();
    lump_bodies();
  }

  ExpressionMatrix mass_matrix() override {
    const ExpressionMatrix SC = dependent_mass_matrix().lazyProduct(C_);
    ExpressionMatrix M(model_.n(), model_.n());
    for (int i = 0; i < model_.n(); ++i)
      for (int j = 0; j <= i; ++j) M(i, j) = M(j, i) = C_.col(i).dot(SC.col(j));
    return M;
  }

  ExpressionVector bias() override { return C_.transpose().lazyProduct(newton_euler(workspace_.q_bias)); }

  ExpressionVector inverse_dynamics(const ExpressionVector& psidd) override {
    const ExpressionVector qdd = C_.lazyProduct(psidd) + workspace_.q_bias;
    return C_.transpose().lazyProduct(newton_euler(qdd));
  }

  Energy<E> energy() override {
    Energy<E> energy;
    const ExpressionVector momentum = dependent_mass_matrix().lazyProduct(workspace_.qd);
    energy.kinetic = E(0.5) * workspace_.qd.dot(momentum);
    energy.potential = potential();
    return energy;
  }

 private:
  struct Link {
    Turn theta, alpha;
    V3 way;  // (a, 0, s): from the parent's origin to this frame's, in mid
    bool moves = false;
  };

  void place_links() {
    for (const auto& link : model_.links) {
      Link placed;
      placed.alpha = {link.cos_alpha, link.sin_alpha};
      placed.theta = {link.cos_theta, link.sin_theta};
      placed.moves = link.coordinate >= 0;
      E s = link.s;
      if (placed.moves && link.prismatic) s += link.scale * workspace_.q[link.coordinate];
      if (placed.moves && !link.prismatic) {
        const E angle = link.scale * workspace_.q[link.coordinate] + link.theta;
        placed.theta = {cos(angle), sin(angle)};
      }
      placed.way = {link.a, E(0.0), s};
      links_.push_back(placed);
    }
  }

  // What a frame's inertia is to its parent: in the axes of mid, about the parent's origin.
  Inertia in_mid(std::size_t i, const Inertia& own) const {
    const Link& link = links_[i];
    Inertia mid;
    mid.mass = own.mass;
    const V3 moment = link.alpha.back_x(own.moment);
    mid.moment = moment + link.way * own.mass;
    const M3 cross_term = parallel_axis(link.way, moment);
    mid.tensor = link.alpha.back_x(own.tensor) + cross_term + cross_term.transpose() +
                 parallel_axis(link.way, V3(link.way * own.mass));
    return mid;
  }

  static Inertia turned_back(const Turn& theta, const Inertia& mid) {
    return {mid.mass, theta.back_z(mid.moment), theta.back_z(mid.tensor)};
  }

  // One inertia a frame; what hangs on a fixed transform goes to the frame that carries it.
  void lump_bodies() {
    inertias_.resize(links_.size() + 1);
    for (const auto& body : model_.bodies) {
      Inertia own;
      own.mass = body.mass;
      own.moment = body.center_of_mass * body.mass;
      own.tensor = body.inertia + parallel_axis(body.center_of_mass, own.moment);
      inertias_[static_cast<std::size_t>(body.frame)] += own;
    }
    for (std::size_t i = links_.size(); i-- > 0;) {
      if (links_[i].moves) continue;
      inertias_[parent(i)] += turned_back(links_[i].theta, in_mid(i, inertias_[i + 1]));
      inertias_[i + 1] = Inertia();
    }
  }

  std::size_t parent(std::size_t i) const { return static_cast<std::size_t>(model_.links[i].parent); }
  bool prismatic(std::size_t i) const { return model_.links[i].prismatic; }
  int coordinate(std::size_t i) const { return model_.links[i].coordinate; }
  const E& scale(std::size_t i) const { return model_.links[i].scale; }

  // A wrench on a frame, at the parent's origin in mid.
  Wrench in_mid(std::size_t i, const Wrench& own) const {
    const V3 force = links_[i].alpha.back_x(own.force);
    return {force, links_[i].alpha.back_x(own.moment) + cross(links_[i].way, force)};
  }

  Wrench in_parent(std::size_t i, const Wrench& mid) const {
    return {links_[i].theta.back_z(mid.force), links_[i].theta.back_z(mid.moment)};
  }

  const E& along_axis(std::size_t i, const Wrench& mid) const { return prismatic(i) ? mid.force[2] : mid.moment[2]; }

  // sum -[DD_i] (27), m x m, from composite bodies.
  const ExpressionMatrix& dependent_mass_matrix() {
    if (S_.size() > 0) return S_;
    S_ = ExpressionMatrix::Constant(model_.m(), model_.m(), E(0.0));
    std::vector<Inertia> composite = inertias_;
    for (std::size_t i = links_.size(); i-- > 0;) {
      const Inertia mid = in_mid(i, composite[i + 1]);
      composite[parent(i)] += turned_back(links_[i].theta, mid);
      if (links_[i].moves) add_row(i, mid);
    }
    return S_;
  }

  // The wrench that a unit acceleration of joint i takes, felt by i and by every joint below it.
  void add_row(std::size_t i, const Inertia& mid) {
    Wrench wrench;
    if (prismatic(i))
      wrench = {{E(0.0), E(0.0), mid.mass}, {mid.moment[1], -mid.moment[0], E(0.0)}};
    else
      wrench = {{-mid.moment[1], mid.moment[0], E(0.0)}, mid.tensor.col(2)};
    S_(coordinate(i), coordinate(i)) += scale(i) * scale(i) * along_axis(i, wrench);
    std::size_t k = i;
    for (std::size_t frame = parent(i); frame > 0; frame = parent(k)) {
      wrench = in_parent(k, wrench);
      k = frame - 1;
      wrench = in_mid(k, wrench);
      if (!links_[k].moves) continue;
      const E element = scale(i) * scale(k) * along_axis(k, wrench);
      S_(coordinate(k), coordinate(i)) += element;
      S_(coordinate(i), coordinate(k)) += element;
    }
  }

  // Forces on the coordinates for these accelerations: inertia, gravity and loads.
  ExpressionVector newton_euler(const ExpressionVector& qdd) {
    std::vector<Motion> motion(links_.size() + 1);
    motion[0].a = -model_.gravity;
    for (std::size_t i = 0; i < links_.size(); ++i) motion[i + 1] = carried(i, motion[parent(i)], qdd);
    std::vector<Wrench> wrench(links_.size() + 1);
    for (std::size_t f = 1; f < wrench.size(); ++f) wrench[f] = inertial_wrench(inertias_[f], motion[f]);
    subtract_loads(wrench);
    ExpressionVector force = ExpressionVector::Constant(model_.m(), E(0.0));
    for (std::size_t i = links_.size(); i-- > 0;) {
      const Wrench mid = in_mid(i, wrench[i + 1]);
      if (links_[i].moves) force[coordinate(i)] += scale(i) * along_axis(i, mid);
      const Wrench below = in_parent(i, mid);
      wrench[parent(i)].force += below.force;
      wrench[parent(i)].moment += below.moment;
    }
    add_coordinate_loads<E>(model_, workspace_.q, workspace_.qd, force);
    return force;
  }

  Motion carried(std::size_t i, const Motion& below, const ExpressionVector& qdd) const {
    const Link& link = links_[i];
    Motion mid{link.theta.into_z(below.w), link.theta.into_z(below.alpha), link.theta.into_z(below.a)};
    const V3 w_below = mid.w;
    if (link.moves && !prismatic(i)) {
      const E rate = scale(i) * workspace_.qd[coordinate(i)];
      mid.alpha += V3(mid.w[1] * rate, -(mid.w[0] * rate), scale(i) * qdd[coordinate(i)]);
      mid.w[2] += rate;
    }
    mid.a += cross(mid.alpha, link.way) + cross(mid.w, cross(mid.w, link.way));
    if (link.moves && prismatic(i)) {
      const E twice = E(2.0) * scale(i) * workspace_.qd[coordinate(i)];
      mid.a += V3(w_below[1] * twice, -(w_below[0] * twice), scale(i) * qdd[coordinate(i)]);
    }
    return {link.alpha.into_x(mid.w), link.alpha.into_x(mid.alpha), link.alpha.into_x(mid.a)};
  }

  static Wrench inertial_wrench(const Inertia& body, const Motion& motion) {
    const V3 Iw = body.tensor.lazyProduct(motion.w), Ialpha = body.tensor.lazyProduct(motion.alpha);
    return {V3(motion.a * body.mass + cross(motion.alpha, body.moment) + cross(motion.w, cross(motion.w, body.moment))),
            V3(Ialpha + cross(motion.w, Iw) + cross(body.moment, motion.a))};
  }

  // A vector in inertial axes, in a frame's.
  V3 in_frame(int frame, const V3& x) const {
    if (frame == 0) return x;
    const auto i = static_cast<std::size_t>(frame - 1);
    return links_[i].alpha.into_x(links_[i].theta.into_z(in_frame(model_.links[i].parent, x)));
  }

  void subtract_loads(std::vector<Wrench>& wrench) const {
    const auto timed = [&](int symbol) {
      return symbol == Symbols::kTime ? in_.t : model_.parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)];
    };
    for (std::size_t l = 0; l < model_.loads.size(); ++l) {
      const auto& said = model_.scene->loads[l];
      V3 force, moment;
      for (std::size_t i = 0; i < 3; ++i) {
        force[static_cast<Eigen::Index>(i)] = evaluate<E>(said.force[i], timed);
        moment[static_cast<Eigen::Index>(i)] = evaluate<E>(said.moment[i], timed);
      }
      const V3 local = in_frame(said.frame, force);
      auto& at = wrench[static_cast<std::size_t>(said.frame)];
      at.force -= local;
      at.moment -= moment + cross(model_.loads[l].point, local);
    }
  }

  // -sum m g . p, gravity carried into the frames.
  E potential() const {
    std::vector<V3> gravity(links_.size() + 1, model_.gravity);
    std::vector<E> height(links_.size() + 1, E(0.0));  // g . (origin of the frame)
    E potential = -inertias_[0].moment.dot(model_.gravity);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const V3 mid = links_[i].theta.into_z(gravity[parent(i)]);
      height[i + 1] = height[parent(i)] + mid.dot(links_[i].way);
      gravity[i + 1] = links_[i].alpha.into_x(mid);
      potential -= inertias_[i + 1].mass * height[i + 1] + inertias_[i + 1].moment.dot(gravity[i + 1]);
    }
    return potential + spring_potential<E>(model_, workspace_.q);
  }

  TracedInputs in_;
  Model<E> model_;
  Workspace<E> workspace_;  // q, qd, q_bias
  ExpressionMatrix C_, S_;
  std::vector<Link> links_;
  std::vector<Inertia> inertias_;  // of each frame
};

}  // namespace

std::unique_ptr<Tracer> recursive_tracer(std::shared_ptr<const Scene> scene) {
  return std::make_unique<RecursiveTracer>(std::move(scene));
}

}  // namespace mixloop
