// SPDX-License-Identifier: MIT
// Composite rigid bodies and Newton-Euler along the tree (Featherstone, Rigid Body Dynamics Algorithms,
// ch. 5 and 6), in link frames; then C, as (31) and (32).
#include "dynamics/symbolic/link_frames.hpp"

namespace mixloop {
namespace {

using E = Expression;
using V3 = Expression3;

struct LinkMotion {
  V3 w = zero3(), alpha = zero3(), a = zero3();
};

// What moves the tree beside accelerations.
struct Driven {
  ExpressionVector qd;
  V3 gravity;
};

class RecursiveTracer final : public Tracer {
 public:
  explicit RecursiveTracer(const std::shared_ptr<const Scene>& scene) : frames_(scene) {}

  ExpressionMatrix mass_matrix() override {
    if (is_long()) return mass_matrix_by_columns();
    const ExpressionMatrix SC = dependent_mass_matrix().lazyProduct(C());
    const int n = model().n();
    ExpressionMatrix M(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) M(i, j) = M(j, i) = C().col(i).dot(SC.col(j));
    return M;
  }

  ExpressionVector mass_times(const ExpressionVector& a) override {
    const ExpressionVector qdd = C().lazyProduct(a);
    return C().transpose().lazyProduct(dependent_mass_times(qdd));
  }

  ExpressionVector bias() override { return forces(at().q_bias); }

  ExpressionVector inverse_dynamics(const ExpressionVector& psidd) override {
    const ExpressionVector qdd = C().lazyProduct(psidd) + at().q_bias;
    return forces(qdd);
  }

  ExpressionVector slopes(int coordinate) override { return at().C.row(coordinate).transpose(); }
  std::vector<Cut> cuts() const override { return frames_.chains().cuts(at()); }
  std::vector<E> solved_from_start() const override {
    return frames_.chains().solved_from_start(model(), at());
  }

  Energy<E> energy() override {
    Energy<E> energy;
    const ExpressionVector momentum =
        is_long() ? dependent_mass_times(at().qd) : dependent_mass_matrix().lazyProduct(at().qd).eval();
    energy.kinetic = E(0.5) * at().qd.dot(momentum);
    energy.potential = potential();
    return energy;
  }

 private:
  const Model<E>& model() const { return frames_.model(); }
  const Workspace<E>& at() const { return frames_.coordinates(); }
  const ExpressionMatrix& C() const { return at().C; }

  const E& along_axis(std::size_t i, const Wrench& mid) const {
    return frames_.prismatic(i) ? mid.force[2] : mid.moment[2];
  }

  // The composite bodies' matrix takes the square of the links that move, about 20 operations each, a column
  // of M about 100 a link.
  bool is_long() const {
    std::size_t moving = 0;
    for (std::size_t i = 0; i < frames_.size(); ++i) moving += frames_[i].moves;
    return moving > 64 && moving > 6 * static_cast<std::size_t>(model().n());
  }

  ExpressionMatrix mass_matrix_by_columns() {
    const int n = model().n();
    ExpressionMatrix M(n, n);
    for (int j = 0; j < n; ++j) {
      ExpressionVector unit = ExpressionVector::Constant(n, E(0.0));
      unit[j] = 1.0;
      const ExpressionVector column = mass_times(unit);
      for (int i = j; i < n; ++i) M(i, j) = M(j, i) = column[i];
    }
    return M;
  }

  // S qdd, (27): Newton-Euler at rest without weight, what these accelerations take.
  ExpressionVector dependent_mass_times(const ExpressionVector& qdd) const {
    const Driven at_rest{ExpressionVector::Constant(model().m(), E(0.0)), zero3()};
    std::vector<Wrench> wrench = inertial_wrenches(qdd, at_rest);
    return along_coordinates(wrench);
  }

  // sum -[DD_i] (27), m x m, from composite bodies.
  const ExpressionMatrix& dependent_mass_matrix() {
    if (S_.size() > 0) return S_;
    S_ = ExpressionMatrix::Constant(model().m(), model().m(), E(0.0));
    std::vector<Inertia> composite = frames_.inertias();
    for (std::size_t i = frames_.size(); i-- > 0;) {
      const Inertia mid = frames_.in_mid(i, composite[i + 1]);
      composite[frames_.parent(i)] += frames_.in_parent(i, mid);
      if (frames_[i].moves) add_row(i, mid);
    }
    return S_;
  }

  // The wrench that a unit acceleration of joint i takes, felt by i and by every joint below it.
  void add_row(std::size_t i, const Inertia& mid) {
    Wrench wrench;
    if (frames_.prismatic(i))
      wrench = {{E(0.0), E(0.0), mid.mass}, {mid.moment[1], -mid.moment[0], E(0.0)}};
    else
      wrench = {{-mid.moment[1], mid.moment[0], E(0.0)}, mid.tensor.col(2)};
    S_(frames_.coordinate(i), frames_.coordinate(i)) +=
        frames_.scale(i) * frames_.scale(i) * along_axis(i, wrench);
    std::size_t k = i;
    for (std::size_t frame = frames_.parent(i); frame > 0; frame = frames_.parent(k)) {
      wrench = frames_.in_parent(k, wrench);
      k = frame - 1;
      wrench = frames_.in_mid(k, wrench);
      if (!frames_[k].moves) continue;
      const E element = frames_.scale(i) * frames_.scale(k) * along_axis(k, wrench);
      S_(frames_.coordinate(k), frames_.coordinate(i)) += element;
      S_(frames_.coordinate(i), frames_.coordinate(k)) += element;
    }
  }

  // (32): forces on psi for these accelerations of the coordinates: inertia, gravity, loads.
  ExpressionVector forces(const ExpressionVector& qdd) {
    std::vector<Wrench> wrench = inertial_wrenches(qdd, {at().qd, model().gravity});
    frames_.subtract_loads(wrench);
    ExpressionVector force = along_coordinates(wrench);
    ExpressionVector on_psi = ExpressionVector::Constant(model().n(), E(0.0));
    frames_.add_spring_dampers(force, on_psi);
    return C().transpose().lazyProduct(force) + on_psi;
  }

  std::vector<Wrench> inertial_wrenches(const ExpressionVector& qdd, const Driven& driven) const {
    std::vector<LinkMotion> motion(frames_.size() + 1);
    motion[0].a = -driven.gravity;
    for (std::size_t i = 0; i < frames_.size(); ++i)
      motion[i + 1] = carried(i, motion[frames_.parent(i)], driven.qd, qdd);
    std::vector<Wrench> wrench(frames_.size() + 1);
    for (std::size_t f = 1; f < wrench.size(); ++f)
      wrench[f] = inertial_wrench(frames_.inertias()[f], motion[f]);
    return wrench;
  }

  // The frames' wrenches, summed down the tree, along each coordinate.
  ExpressionVector along_coordinates(std::vector<Wrench>& wrench) const {
    ExpressionVector force = ExpressionVector::Constant(model().m(), E(0.0));
    for (std::size_t i = frames_.size(); i-- > 0;) {
      const Wrench mid = frames_.in_mid(i, wrench[i + 1]);
      if (frames_[i].moves) force[frames_.coordinate(i)] += frames_.scale(i) * along_axis(i, mid);
      const Wrench below = frames_.in_parent(i, mid);
      wrench[frames_.parent(i)].force += below.force;
      wrench[frames_.parent(i)].moment += below.moment;
    }
    return force;
  }

  LinkMotion carried(std::size_t i, const LinkMotion& below, const ExpressionVector& qd,
                     const ExpressionVector& qdd) const {
    const LinkFrames::Link& link = frames_[i];
    LinkMotion mid{link.theta.into_z(below.w), link.theta.into_z(below.alpha), link.theta.into_z(below.a)};
    const V3 w_below = mid.w;
    if (link.moves && !frames_.prismatic(i)) {
      const E rate = frames_.scale(i) * qd[frames_.coordinate(i)];
      mid.alpha += V3(mid.w[1] * rate, -(mid.w[0] * rate), frames_.scale(i) * qdd[frames_.coordinate(i)]);
      mid.w[2] += rate;
    }
    mid.a += cross(mid.alpha, link.way) + cross(mid.w, cross(mid.w, link.way));
    if (link.moves && frames_.prismatic(i)) {
      const E twice = E(2.0) * frames_.scale(i) * qd[frames_.coordinate(i)];
      mid.a += V3(w_below[1] * twice, -(w_below[0] * twice), frames_.scale(i) * qdd[frames_.coordinate(i)]);
    }
    return {link.alpha.into_x(mid.w), link.alpha.into_x(mid.alpha), link.alpha.into_x(mid.a)};
  }

  static Wrench inertial_wrench(const Inertia& body, const LinkMotion& motion) {
    const V3 Iw = body.tensor.lazyProduct(motion.w), Ialpha = body.tensor.lazyProduct(motion.alpha);
    return {V3(motion.a * body.mass + cross(motion.alpha, body.moment) +
               cross(motion.w, cross(motion.w, body.moment))),
            V3(Ialpha + cross(motion.w, Iw) + cross(body.moment, motion.a))};
  }

  // -sum m g . p, gravity carried into the frames.
  E potential() const {
    std::vector<V3> gravity(frames_.size() + 1, model().gravity);
    std::vector<E> height(frames_.size() + 1, E(0.0));  // g . (origin of the frame)
    E potential = -frames_.inertias()[0].moment.dot(model().gravity);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const V3 mid = frames_[i].theta.into_z(gravity[frames_.parent(i)]);
      height[i + 1] = height[frames_.parent(i)] + mid.dot(frames_[i].way);
      gravity[i + 1] = frames_[i].alpha.into_x(mid);
      potential -= frames_.inertias()[i + 1].mass * height[i + 1] +
                   frames_.inertias()[i + 1].moment.dot(gravity[i + 1]);
    }
    return potential + frames_.spring_potentials();
  }

  LinkFrames frames_;
  ExpressionMatrix S_;
};

}  // namespace

std::unique_ptr<Tracer> recursive_tracer(std::shared_ptr<const Scene> scene) {
  return std::make_unique<RecursiveTracer>(scene);
}

}  // namespace mixloop
