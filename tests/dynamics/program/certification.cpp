// SPDX-License-Identifier: MIT
#include "certification.hpp"

#include <limits>

namespace mixloop::testing {
namespace {

using WideVector = Vec<Wide>;
using WideMatrix = Mat<Wide>;

class WideProcedure {
 public:
  WideProcedure(const std::shared_ptr<const Scene>& scene, std::span<const double> parameters,
                const Sample& sample)
      : n_(scene->n()),
        n_u_(scene->n_u()),
        model_(make_model<Wide>(scene, std::span<const Wide>(wide(parameters)))),
        workspace_(model_),
        psi_(wide(sample.psi)),
        psid_(wide(sample.psid)),
        input_(wide(sample.input)),
        t_(sample.t) {}

  Oracle of(Purpose purpose) {
    switch (purpose) {
      case Purpose::forward_dynamics:
        forward_dynamics(0);
        break;
      case Purpose::mass_times:
        mass_times(0);
        break;
      case Purpose::mass_matrix:
        put(M(), M().norm());
        break;
      case Purpose::bias:
        put(h(), bias_scale());
        break;
      case Purpose::inverse_dynamics:
        inverse_dynamics();
        break;
      case Purpose::end_effector:
        end_effector();
        break;
      case Purpose::energy:
        energy();
        break;
      case Purpose::linearisation:
        linearisation();
        break;
      case Purpose::dynamics_and_mass_times:
        forward_dynamics(0);
        mass_times(n_u_);
        break;
    }
    return result_;
  }

 private:
  static std::vector<Wide> wide(std::span<const double> x) { return {x.begin(), x.end()}; }
  std::span<const Wide> psi() const { return psi_; }
  std::span<const Wide> psid() const { return psid_; }
  std::span<const Wide> input(int from) const {
    return std::span(input_).subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(n_));
  }

  // The motors' part of the input, and nothing for the free coordinates.
  WideVector of_motors(int from) {
    WideVector x = map_of(input(from));
    x.tail(n_ - n_u_).setZero();
    return x;
  }

  WideMatrix M() { return mixloop::mass_matrix<Wide>(model_, psi(), t_, workspace_); }
  WideVector h() { return mixloop::bias<Wide>(model_, psi(), psid(), t_, workspace_); }

  template <class Derived>
  void put(const Eigen::MatrixBase<Derived>& x, const Wide& scale) {
    for (Eigen::Index j = 0; j < x.cols(); ++j)
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        result_.value.push_back(x(i, j));
        result_.scale.push_back(static_cast<double>(scale));
      }
  }

  // Gravity and velocity products each at its own size, though they may cancel in h.
  Wide bias_scale() {
    std::vector<Wide> rest(psid_.size(), Wide(0));
    const WideVector weight = mixloop::bias<Wide>(model_, psi(), rest, t_, workspace_);
    const WideVector all = h();
    Wide speed = 0;
    for (const Wide& x : psid_) speed += x * x;
    return weight.norm() + (all - weight).norm() + M().norm() * speed + pull_of_springs();
  }

  // What springs along lines would pull without a rest, though that, or gravity, takes most of it away.
  Wide pull_of_springs() {
    if (model_.along_loads.empty() && model_.between_loads.empty()) return 0;
    Model<Wide> slack = model_;
    for (auto& load : slack.along_loads) load.law.rest = 0;
    for (auto& load : slack.between_loads) load.law.rest = 0;
    std::vector<Wide> still(psid_.size(), Wide(0));
    const WideVector at_rest = WideVector::Zero(model_.m());
    WideVector on_q = at_rest, on_psi = WideVector::Zero(n_);
    add_line_loads<Wide>(slack, {psi(), still, workspace_.q, at_rest, t_}, workspace_.line, on_q, on_psi);
    return (workspace_.C.transpose() * on_q).norm() + on_psi.norm();
  }

  void mass_times(int from) {
    const WideVector a = of_motors(from);
    put(WideVector((M() * a).head(n_u_)), M().norm() * a.norm());
  }

  void inverse_dynamics() {
    const WideVector a = map_of(input(0));
    const WideVector inertial = M() * a;
    put(WideVector(inertial + h()), M().norm() * a.norm() + bias_scale());
  }

  // Round-off in M and h reaches psidd through M^-1.
  Wide inverse_norm() {
    WideMatrix L = M(), inverse(n_, n_);
    factor_ldlt(L);
    for (int j = 0; j < n_; ++j) {
      WideVector column = WideVector::Unit(n_, j);
      solve_ldlt(L, column);
      inverse.col(j) = column;
    }
    return inverse.norm();
  }

  void forward_dynamics(int from) {
    const WideVector psidd =
        mixloop::forward_dynamics<Wide>(model_, psi(), psid(), input(from), t_, workspace_);
    const WideVector tau = of_motors(from);
    put(psidd, inverse_norm() * (M().norm() * psidd.norm() + tau.norm() + bias_scale()));
  }

  void end_effector() {
    const auto state = mixloop::end_effector<Wide>(model_, psi(), psid(), input(0), t_, workspace_);
    Wide reach = model_.end_effector_point.norm(), speed = 1, pull = 1;
    for (const auto& link : model_.links) reach += abs(link.a) + abs(link.s) + (link.prismatic ? 1 : 0);
    for (const Wide& x : psid_) speed += abs(x);
    for (const Wide& x : input(0)) pull += abs(x);
    put(state.position, reach);
    put(state.velocity, reach * speed);
    put(state.acceleration, reach * (speed * speed + pull));
    put(state.jacobian, reach);
  }

  void energy() {
    const auto energy = mixloop::energy<Wide>(model_, psi(), psid(), t_, workspace_);
    Wide weight = 0, reach = 0;
    for (const auto& link : model_.links) reach += abs(link.a) + abs(link.s) + (link.prismatic ? 1 : 0);
    for (const auto& body : model_.bodies) weight += body.mass * (reach + body.center_of_mass.norm());
    put(Vec<Wide>::Constant(1, energy.kinetic), energy.kinetic);
    put(Vec<Wide>::Constant(1, energy.potential), weight * model_.gravity.norm() + spring_scale());
  }

  // Of k/2 (q - rest)^2, with q as large as what it is summed from.
  Wide spring_scale() {
    Wide sum = 0, reach = 1;
    for (const Wide& x : psi_) reach += abs(x);
    for (const auto& load : model_.coordinate_loads) {
      const Wide slopes = workspace_.C.row(load.coordinate).norm();
      const Wide size = abs(workspace_.q[load.coordinate]) + slopes * reach + abs(load.rest);
      sum += load.stiffness * size * size / 2;
    }
    const LineState<Wide> at{psi(), psid(), workspace_.q, workspace_.qd, t_};
    for (std::size_t i = 0; i < model_.along_loads.size(); ++i) {
      const auto& [law, names] = model_.along_loads[i];
      Wide size = abs(detail::along_value(model_, i, at)) + abs(law.rest);
      for (const int name : names) size += abs(detail::along_partial(model_, i, at, name)) * reach;
      sum += law.stiffness * size * size / 2;
    }
    for (const auto& load : model_.between_loads) {
      const Wide size = detail::between(model_, load, at, workspace_.line).at.norm() + load.law.rest + reach;
      sum += load.law.stiffness * size * size / 2;
    }
    return sum;
  }

  WideVector psidd_at(const std::vector<Wide>& psi, const std::vector<Wide>& psid,
                      const std::vector<Wide>& tau) {
    return mixloop::forward_dynamics<Wide>(
        model_, psi, psid, std::span(tau).first(static_cast<std::size_t>(n_)), t_, workspace_);
  }

  // Central differences in 113 bits: good to 1e-20 or so, far below a double's round-off.
  void linearisation() {
    const Wide step = 1e-11;
    const Wide scale = inverse_norm() * inverse_norm() * M().norm() *
                       (M().norm() * psidd_at(psi_, psid_, input_).norm() + bias_scale() + 1);
    for (auto* x : {&psi_, &psid_, &input_})
      for (std::size_t j = 0; j < static_cast<std::size_t>(x == &input_ ? n_u_ : n_); ++j) {
        const Wide at = (*x)[j];
        (*x)[j] = at + step;
        const WideVector above = psidd_at(psi_, psid_, input_);
        (*x)[j] = at - step;
        const WideVector below = psidd_at(psi_, psid_, input_);
        (*x)[j] = at;
        put(WideVector((above - below) / (2 * step)), scale);
      }
  }

  int n_, n_u_;
  Model<Wide> model_;
  Workspace<Wide> workspace_;
  std::vector<Wide> psi_, psid_, input_;
  Wide t_;
  Oracle result_;
};

}  // namespace

Oracle oracle(const std::shared_ptr<const Scene>& scene, std::span<const double> parameters, Purpose purpose,
              const Sample& sample) {
  return WideProcedure(scene, parameters, sample).of(purpose);
}

double error_in_ulps(const Oracle& oracle, std::span<const double> outputs) {
  double worst = 0.0;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const double error = static_cast<double>(abs(oracle.value[k] - Wide(outputs[k])));
    if (error == 0.0) continue;
    worst = std::max(worst, error / (oracle.scale[k] * std::numeric_limits<double>::epsilon()));
    if (!(error == error)) return std::numeric_limits<double>::infinity();
  }
  return worst;
}

}  // namespace mixloop::testing
