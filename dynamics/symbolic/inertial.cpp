// SPDX-License-Identifier: MIT
// Frames in inertial axes: what turns in one plane is written down by its angle from the ground, as closures
// are solved for it. Newton and Euler along C (31), (32).
//
// A link's kinetic energy about its joint, o, is m/2 v_o^2 + v_o . (w x h) + w I w / 2 with its first moment
// h and its inertia I about the joint, constant in the link's axes. A turning joint is a point of the link
// below: the mass goes there, and what is left are the terms with h and I.
#include "dynamics/procedure/bodies.hpp"
#include "dynamics/symbolic/link_frames.hpp"

namespace mixloop {
namespace {

using E = Expression;
using V3 = Expression3;
using Pose = PoseAlong<E>;

V3 vector_of(const Pose::Column& column) { return {column[0], column[1], column[2]}; }

// w x (w x r), which is -w^2 r where r is across w.
V3 centripetal(const V3& w, const V3& r) { return w * w.dot(r) - r * w.dot(w); }

/// How a frame moves along one direction in the space of psi, or in time.
struct Motion {
  V3 w = zero3(), v = zero3();
};

class InertialTracer final : public Tracer {
 public:
  explicit InertialTracer(const std::shared_ptr<const Scene>& scene) : frames_(scene) {
    place();
    lump();
    for (int k = 0; k < model().n(); ++k) columns_.push_back(motions([&](int j) { return at().C(j, k); }));
  }

  ExpressionMatrix mass_matrix() override {
    const int n = model().n();
    ExpressionMatrix M(n, n);
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i) {
        E sum = 0.0;
        for (const Element& e : elements_) sum += inner_product(e, i, j);
        M(i, j) = M(j, i) = sum;
      }
    return M;
  }

  ExpressionVector bias() override {
    const std::vector<Motion> rates = motions([&](int j) { return at().qd[j]; });
    const std::vector<Motion> accelerations = bias_accelerations(rates);
    ExpressionVector load = ExpressionVector::Constant(model().m(), E(0.0));
    ExpressionVector on_psi = ExpressionVector::Constant(model().n(), E(0.0));
    add_coordinate_loads<E>(model(), at().q, at().qd, load);
    add_along_loads<E>(model(), frames_.line_state(), load, on_psi);
    ExpressionVector h = at().C.transpose().lazyProduct(load) + on_psi;
    for (const Element& e : elements_) {
      const V3& w = rates[e.frame].w;
      const V3& alpha = accelerations[e.frame].w;
      const V3 a = accelerations[e.origin].v - model().gravity;
      const V3 Ia = local(e, alpha), Iw = local(e, w);
      const V3 spin = e.tensor.lazyProduct(Ia) + cross(Iw, V3(e.tensor.lazyProduct(Iw)));
      const V3 inertial = cross(alpha, e.moment) + centripetal(w, e.moment);
      for (int k = 0; k < h.size(); ++k) {
        const auto& column = columns_[static_cast<std::size_t>(k)];
        const V3 &wk = column[e.frame].w, &vk = column[e.origin].v;
        h[k] += a.dot(V3(vk * e.mass + cross(wk, e.moment))) + vk.dot(inertial) + local(e, wk).dot(spin);
      }
    }
    subtract_loads(h);
    add_between_loads(rates, h);
    return h;
  }

  Energy<E> energy() override {
    const std::vector<Motion> rates = motions([&](int j) { return at().qd[j]; });
    Energy<E> energy;
    for (const Element& e : elements_) {
      const V3 &w = rates[e.frame].w, &v = rates[e.origin].v;
      const V3 Iw = local(e, w);
      energy.kinetic += E(0.5) * e.mass * v.dot(v) + v.dot(cross(w, e.moment)) +
                        E(0.5) * Iw.dot(V3(e.tensor.lazyProduct(Iw)));
      energy.potential -= model().gravity.dot(V3(vector_of(poses_[e.origin].origin) * e.mass + e.moment));
    }
    energy.potential -= frames_.inertias()[0].moment.dot(model().gravity);
    energy.potential += frames_.spring_potentials();
    return energy;
  }

  ExpressionVector slopes(int coordinate) override { return at().C.row(coordinate).transpose(); }
  std::vector<Cut> cuts() const override { return frames_.chains().cuts(at()); }
  std::vector<E> solved_from_start() const override {
    return frames_.chains().solved_from_start(model(), at());
  }

 private:
  /// A link about a point `origin` of it: the joint's, or where it slides its own.
  struct Element {
    std::size_t frame, origin;
    E mass;
    V3 moment;            ///< in inertial axes
    Expression33 tensor;  ///< in the axes of `axes`
    Pose axes;
  };

  const Model<E>& model() const { return frames_.model(); }
  const Workspace<E>& at() const { return frames_.coordinates(); }

  void place() {
    poses_.resize(frames_.size() + 1);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const auto& link = model().links[i];
      Pose pose = poses_[frames_.parent(i)];
      if (frames_[i].moves && !frames_.prismatic(i))
        pose.turn(link.scale * at().q[link.coordinate] + link.theta);
      else
        pose.turn(link.cos_theta, link.sin_theta);
      mid_.push_back(pose);
      pose.shift(frames_[i].way[2], link.a);
      pose.twist(link.cos_alpha, link.sin_alpha, link.twist);
      poses_[i + 1] = pose;
    }
  }

  void lump() {
    std::vector<Inertia> own = frames_.inertias();
    for (std::size_t i = frames_.size(); i-- > 0;) {
      const std::size_t parent = frames_.parent(i);
      if (!frames_[i].moves) {
        own[parent] += frames_.in_parent(i, frames_.in_mid(i, own[i + 1]));
        continue;
      }
      if (frames_.prismatic(i)) {
        add({i + 1, i + 1, own[i + 1].mass, zero3(), own[i + 1].tensor, poses_[i + 1]}, own[i + 1].moment);
        continue;
      }
      const Inertia mid = frames_.in_mid(i, own[i + 1]);
      add({i + 1, parent, E(0.0), zero3(), mid.tensor, mid_[i]}, mid.moment);
      own[parent].mass += mid.mass;
    }
  }

  void add(Element element, const V3& moment) {
    element.moment = vector_of(element.axes.turned(moment));
    elements_.push_back(std::move(element));
  }

  static V3 local(const Element& e, const V3& w) {
    return {vector_of(e.axes.axes[0]).dot(w), vector_of(e.axes.axes[1]).dot(w),
            vector_of(e.axes.axes[2]).dot(w)};
  }

  V3 joint(std::size_t i) const { return vector_of(poses_[frames_.parent(i)].axes[2]); }
  V3 way(std::size_t i) const {
    return vector_of(mid_[i].axes[0]) * model().links[i].a + vector_of(mid_[i].axes[2]) * frames_[i].way[2];
  }

  template <class RateOf>
  std::vector<Motion> motions(const RateOf& rate_of) const {
    std::vector<Motion> motions(frames_.size() + 1);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const Motion& below = motions[frames_.parent(i)];
      Motion& mine = motions[i + 1];
      mine = below;
      V3 slide = zero3();
      if (frames_[i].moves) {
        const V3 rate = joint(i) * (frames_.scale(i) * rate_of(frames_.coordinate(i)));
        frames_.prismatic(i) ? slide = rate : mine.w = V3(mine.w + rate);
      }
      mine.v = below.v + cross(mine.w, way(i)) + slide;
    }
    return motions;
  }

  /// Angular and linear accelerations where psi'' is nothing.
  std::vector<Motion> bias_accelerations(const std::vector<Motion>& rates) const {
    std::vector<Motion> accelerations(frames_.size() + 1);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const std::size_t parent = frames_.parent(i);
      const Motion& below = accelerations[parent];
      Motion& mine = accelerations[i + 1];
      mine = below;
      const V3& w = rates[i + 1].w;
      V3 slide = zero3();
      if (frames_[i].moves) {
        const E rate = frames_.scale(i) * at().qd[frames_.coordinate(i)],
                change = frames_.scale(i) * at().q_bias[frames_.coordinate(i)];
        const V3 z = joint(i), swung = cross(rates[parent].w, z);
        if (frames_.prismatic(i))
          slide = z * change + swung * (E(2.0) * rate);
        else
          mine.w += z * change + swung * rate;
      }
      const V3 r = way(i);
      mine.v = below.v + cross(mine.w, r) + centripetal(w, r) + slide;
    }
    return accelerations;
  }

  E inner_product(const Element& e, int i, int j) const {
    const auto &of_i = columns_[static_cast<std::size_t>(i)], &of_j = columns_[static_cast<std::size_t>(j)];
    const V3 &wi = of_i[e.frame].w, &wj = of_j[e.frame].w, &vi = of_i[e.origin].v, &vj = of_j[e.origin].v;
    const E turning = local(e, wi).dot(V3(e.tensor.lazyProduct(local(e, wj))));
    const E translating = e.mass * vi.dot(vj);
    if (i == j) return turning + translating + E(2.0) * vi.dot(cross(wi, e.moment));
    return turning + translating + vi.dot(cross(wj, e.moment)) + vj.dot(cross(wi, e.moment));
  }

  // (21), last two terms: forces in inertial axes at a point, moments in the frame's axes.
  void subtract_loads(ExpressionVector& h) const {
    std::vector<Wrench> wrench(frames_.size() + 1);
    frames_.subtract_loads(wrench);
    for (std::size_t f = 1; f < wrench.size(); ++f) {
      const V3 force = vector_of(poses_[f].turned(wrench[f].force)),
               moment = vector_of(poses_[f].turned(wrench[f].moment));
      for (int k = 0; k < h.size(); ++k) {
        const Motion& column = columns_[static_cast<std::size_t>(k)][f];
        h[k] += column.v.dot(force) + column.w.dot(moment);
      }
    }
  }

  /// Where an end of a load between points is, and how it moves by some direction.
  V3 arm_of(std::size_t load, std::size_t end) const {
    const auto frame = static_cast<std::size_t>(model().scene->between_loads[load].ends[end].frame);
    return vector_of(poses_[frame].turned(model().between_loads[load].point[end]));
  }
  V3 parted_by(std::size_t load, const std::vector<Motion>& motions) const {
    V3 by = zero3();
    for (std::size_t end : {0u, 1u}) {
      const auto frame = static_cast<std::size_t>(model().scene->between_loads[load].ends[end].frame);
      const V3 move = motions[frame].v + cross(motions[frame].w, arm_of(load, end));
      by = end == 1 ? V3(by + move) : V3(by - move);
    }
    return by;
  }

  void add_between_loads(const std::vector<Motion>& rates, ExpressionVector& h) const {
    for (std::size_t i = 0; i < model().between_loads.size(); ++i) {
      const auto& load = model().between_loads[i];
      const auto& ends = model().scene->between_loads[i].ends;
      const auto place = [&](std::size_t end) {
        return V3(vector_of(poses_[static_cast<std::size_t>(ends[end].frame)].origin) + arm_of(i, end));
      };
      const V3 r = place(1) - place(0);
      const V3 force = r * detail::taken_a_metre<E>(load, r, load.damps ? parted_by(i, rates) : zero3());
      for (int k = 0; k < h.size(); ++k)
        h[k] += force.dot(parted_by(i, columns_[static_cast<std::size_t>(k)]));
    }
  }

  LinkFrames frames_;
  std::vector<Pose> poses_;  ///< of each frame
  std::vector<Pose> mid_;    ///< of each link, before its constant twist, at the joint
  std::vector<Element> elements_;
  std::vector<std::vector<Motion>> columns_;  ///< of each independent coordinate
};

}  // namespace

std::unique_ptr<Tracer> inertial_tracer(std::shared_ptr<const Scene> scene) {
  // Of open chains the others' programs stay as they are.
  if (!scene->is_closed()) return nullptr;
  return std::make_unique<InertialTracer>(scene);
}

}  // namespace mixloop
