// SPDX-License-Identifier: MIT
// Articulated bodies (Featherstone, Rigid Body Dynamics Algorithms, ch. 7) in link frames: forward dynamics
// in a number of operations that grows as n, where each independent coordinate moves one joint of the tree.
//
// A frame's wrench is [n; f] = [I H; H^T M] [alpha; a] + [pn; pf], with alpha the angular acceleration of the
// link and a the (classical) acceleration of the frame's origin.
#include <optional>

#include "dynamics/symbolic/link_frames.hpp"

namespace mixloop {
namespace {

using E = Expression;
using V3 = Expression3;
using M3 = Expression33;

M3 zero33() { return M3::Constant(E(0.0)); }

// r x, as a matrix.
M3 cross_matrix(const V3& r) {
  M3 R;
  R << E(0.0), -r[2], r[1], r[2], E(0.0), -r[0], -r[1], r[0], E(0.0);
  return R;
}

struct Articulated {
  M3 I = zero33(), H = zero33(), M = zero33();
  Wrench p;
};

// A general matrix in turned axes, R A R^T.
template <class Rotate>
M3 turned(const M3& A, Rotate rotate) {
  M3 half, whole;
  for (Eigen::Index j = 0; j < 3; ++j) half.col(j) = rotate(V3(A.col(j)));
  for (Eigen::Index i = 0; i < 3; ++i) whole.row(i) = rotate(V3(half.row(i).transpose())).transpose();
  return whole;
}

void make_symmetric(M3& A) {
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < i; ++j) A(i, j) = A(j, i);
}

template <class Rotate>
Articulated turned(const Articulated& b, Rotate rotate) {
  Articulated t{
      turned(b.I, rotate), turned(b.H, rotate), turned(b.M, rotate), {rotate(b.p.force), rotate(b.p.moment)}};
  make_symmetric(t.I), make_symmetric(t.M);
  return t;
}

class ArticulatedTracer final : public Tracer {
 public:
  ArticulatedTracer(const std::shared_ptr<const Scene>& scene, LinkFrames frames,
                    std::vector<int> psi_of_link)
      : recursive_(recursive_tracer(scene)),
        frames_(std::move(frames)),
        psi_(std::move(psi_of_link)),
        above_(frames_.size()),
        w_(frames_.size() + 1, zero3()) {}

  ExpressionMatrix mass_matrix() override { return recursive_->mass_matrix(); }
  ExpressionVector bias() override { return recursive_->bias(); }
  Energy<E> energy() override { return recursive_->energy(); }
  ExpressionVector mass_times(const ExpressionVector& a) override { return recursive_->mass_times(a); }
  ExpressionVector inverse_dynamics(const ExpressionVector& psidd) override {
    return recursive_->inverse_dynamics(psidd);
  }

  ExpressionVector forward_dynamics(const ExpressionVector& tau) override {
    velocities();
    articulate(tau);
    return accelerations();
  }

 private:
  // Of a moving link, as felt at the parent's origin in mid: U = (moment, force) of a unit acceleration along
  // the axis, u = (drive - U . acceleration below) / D the joint's acceleration.
  struct Step {
    V3 U_moment, U_force;
    E inverse_D = 0.0, drive = 0.0;
    V3 alpha_bias = zero3(), a_bias = zero3();  // of joint rates
  };

  const Model<E>& model() const { return frames_.model(); }
  const Workspace<E>& at() const { return frames_.coordinates(); }
  E rate(std::size_t i) const { return frames_.scale(i) * at().qd[frames_.coordinate(i)]; }
  bool turns(std::size_t i) const { return frames_[i].moves && !frames_.prismatic(i); }
  bool slides(std::size_t i) const { return frames_[i].moves && frames_.prismatic(i); }

  void velocities() {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      V3 mid = frames_[i].theta.into_z(w_[frames_.parent(i)]);
      Step& step = above_[i];
      if (turns(i)) {
        step.alpha_bias = {mid[1] * rate(i), -(mid[0] * rate(i)), E(0.0)};
        mid[2] += rate(i);
      } else if (slides(i)) {
        const E twice = E(2.0) * rate(i);
        step.a_bias = {mid[1] * twice, -(mid[0] * twice), E(0.0)};
      }
      w_mid_.push_back(mid);
      w_[i + 1] = frames_[i].alpha.into_x(mid);
    }
  }

  // A link alone: H = m c x, and what its turning takes.
  Articulated rigid(std::size_t frame) const {
    const Inertia& body = frames_.inertias()[frame];
    const V3& w = w_[frame];
    Articulated own;
    own.I = body.tensor;
    own.H = cross_matrix(body.moment);
    for (Eigen::Index k = 0; k < 3; ++k) own.M(k, k) = body.mass;
    const V3 Iw = body.tensor.lazyProduct(w);
    own.p = {cross(w, cross(w, body.moment)), cross(w, Iw)};
    return own;
  }

  // From the frame's origin to the parent's, in mid: I' = I - H r + r H'^T, H' = H + r M.
  Articulated in_mid(std::size_t i, const Articulated& own) const {
    const Turn& turn = frames_[i].alpha;
    Articulated b = turned(own, [&](const V3& x) { return turn.back_x(x); });
    const V3& way = frames_[i].way;
    const M3 r = cross_matrix(way);
    const V3 swing = cross(w_mid_[i], cross(w_mid_[i], way));
    const M3 Hr = b.H.lazyProduct(r);
    b.p.force += V3(b.M.lazyProduct(swing));
    b.p.moment += V3(b.H.lazyProduct(swing)) + cross(way, b.p.force);
    b.H += M3(r.lazyProduct(b.M));
    b.I += M3(r.lazyProduct(b.H.transpose())) - Hr;
    make_symmetric(b.I);
    return b;
  }

  void articulate(const ExpressionVector& tau) {
    std::vector<Articulated> bodies(frames_.size() + 1);
    std::vector<Wrench> loads(frames_.size() + 1);
    frames_.subtract_loads(loads);
    for (std::size_t f = 1; f < bodies.size(); ++f) {
      bodies[f] = rigid(f);
      bodies[f].p.force += loads[f].force, bodies[f].p.moment += loads[f].moment;
    }
    ExpressionVector taken = ExpressionVector::Constant(model().m(), E(0.0));
    ExpressionVector on_psi = ExpressionVector::Constant(model().n(), E(0.0));
    frames_.add_spring_dampers(taken, on_psi);
    const ExpressionVector given = beside_the_joints(tau - on_psi, taken);
    for (std::size_t i = frames_.size(); i-- > 0;) {
      Articulated mid = in_mid(i, bodies[i + 1]);
      if (frames_[i].moves) open_joint(i, given[psi_[i]] / slope(i) - taken[frames_.coordinate(i)], mid);
      if (frames_.parent(i) == 0) continue;
      const Turn& turn = frames_[i].theta;
      const Articulated below = turned(mid, [&](const V3& x) { return turn.back_z(x); });
      Articulated& parent = bodies[frames_.parent(i)];
      parent.I += below.I, parent.H += below.H, parent.M += below.M;
      parent.p.force += below.p.force, parent.p.moment += below.p.moment;
    }
  }

  // What loads at coordinates that are no joint's leave of tau: C^T of them.
  ExpressionVector beside_the_joints(const ExpressionVector& tau, const ExpressionVector& taken) const {
    std::vector<bool> joint(static_cast<std::size_t>(model().m()), false);
    for (std::size_t i = 0; i < frames_.size(); ++i)
      if (frames_[i].moves) joint[static_cast<std::size_t>(frames_.coordinate(i))] = true;
    ExpressionVector given = tau;
    const auto subtract = [&](int j) {
      if (joint[static_cast<std::size_t>(j)]) return;
      joint[static_cast<std::size_t>(j)] = true;  // two loads at one are one in `taken`
      for (Eigen::Index k = 0; k < given.size(); ++k) given[k] -= at().C(j, k) * taken[j];
    };
    for (const auto& load : model().coordinate_loads) subtract(load.coordinate);
    for (int j = 0; j < model().m(); ++j) subtract(j);
    return given;
  }

  const E& slope(std::size_t i) const { return at().C(frames_.coordinate(i), psi_[i]); }

  // Lets the joint go: I - U U^T / D, p + (I - U U^T / D) c + U u0.
  void open_joint(std::size_t i, const E& force, Articulated& b) {
    Step& step = above_[i];
    const bool turning = turns(i);
    step.U_moment = turning ? V3(b.I.col(2)) : V3(b.H.col(2));
    step.U_force = turning ? V3(b.H.row(2).transpose()) : V3(b.M.col(2));
    step.inverse_D = E(1.0) / (turning ? step.U_moment[2] : step.U_force[2]);
    const V3 n = step.U_moment * step.inverse_D, f = step.U_force * step.inverse_D;
    b.I -= M3(step.U_moment * n.transpose());
    b.H -= M3(step.U_moment * f.transpose());
    b.M -= M3(step.U_force * f.transpose());
    make_symmetric(b.I), make_symmetric(b.M);
    // Exactly nothing along the axis, which round-off would not leave.
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (turning)
        b.I(2, k) = b.I(k, 2) = b.H(2, k) = E(0.0);
      else
        b.M(2, k) = b.M(k, 2) = b.H(k, 2) = E(0.0);
    }
    step.drive = force / frames_.scale(i) - (turning ? b.p.moment[2] : b.p.force[2]);
    b.p.moment +=
        V3(b.I.lazyProduct(step.alpha_bias)) + V3(b.H.lazyProduct(step.a_bias)) + V3(n * step.drive);
    b.p.force += V3(b.H.transpose().lazyProduct(step.alpha_bias)) + V3(b.M.lazyProduct(step.a_bias)) +
                 V3(f * step.drive);
  }

  ExpressionVector accelerations() const {
    std::vector<V3> alpha(frames_.size() + 1, zero3()), a(frames_.size() + 1, zero3());
    a[0] = -model().gravity;
    ExpressionVector psidd(model().n());
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const LinkFrames::Link& link = frames_[i];
      const Step& step = above_[i];
      V3 turn = link.theta.into_z(alpha[frames_.parent(i)]) + step.alpha_bias;
      V3 at_joint = link.theta.into_z(a[frames_.parent(i)]) + step.a_bias;
      if (link.moves) {
        const E u = (step.drive - (step.U_moment.dot(turn) + step.U_force.dot(at_joint))) * step.inverse_D;
        (turns(i) ? turn : at_joint)[2] += u;
        psidd[psi_[i]] = (u / frames_.scale(i) - at().q_bias[frames_.coordinate(i)]) / slope(i);
      }
      const V3 swing = cross(w_mid_[i], cross(w_mid_[i], link.way));
      alpha[i + 1] = link.alpha.into_x(turn);
      a[i + 1] = link.alpha.into_x(V3(at_joint + cross(turn, link.way) + swing));
    }
    return psidd;
  }

  std::unique_ptr<Tracer> recursive_;
  LinkFrames frames_;
  std::vector<int> psi_;  // of each link
  std::vector<Step> above_;
  std::vector<V3> w_, w_mid_;
};

// The one independent coordinate that moves each link; nothing where it isn't so.
std::optional<std::vector<int>> one_each(const LinkFrames& frames) {
  const ExpressionMatrix& C = frames.coordinates().C;
  std::vector<int> psi_of_link(frames.size(), -1), links_of_psi(static_cast<std::size_t>(C.cols()), 0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].moves) continue;
    for (Eigen::Index k = 0; k < C.cols(); ++k) {
      const E& c = C(frames.coordinate(i), k);
      if (c.is_number() && c.number() == 0.0) continue;
      if (psi_of_link[i] >= 0 || links_of_psi[static_cast<std::size_t>(k)]++ > 0) return std::nullopt;
      psi_of_link[i] = static_cast<int>(k);
    }
    if (psi_of_link[i] < 0) return std::nullopt;
  }
  for (int links : links_of_psi)
    if (links == 0) return std::nullopt;
  return psi_of_link;
}

}  // namespace

std::unique_ptr<Tracer> articulated_tracer(std::shared_ptr<const Scene> scene) {
  if (!scene->acts_along.empty()) return nullptr;
  LinkFrames frames(scene);
  auto psi_of_link = one_each(frames);
  if (!psi_of_link) return nullptr;
  return std::make_unique<ArticulatedTracer>(scene, std::move(frames), std::move(*psi_of_link));
}

}  // namespace mixloop
