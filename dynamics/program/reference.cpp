// SPDX-License-Identifier: MIT
#include "dynamics/program/reference.hpp"

#include "dynamics/procedure/procedure.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/trace.hpp"

namespace mixloop {
namespace {

template <class Derived>
double* put(const Eigen::MatrixBase<Derived>& values, double* out) {
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (Eigen::Index i = 0; i < values.rows(); ++i) *out++ = values(i, j);
  return out;
}

class Reference final : public Routine {
 public:
  Reference(std::shared_ptr<const Scene> scene, Purpose purpose)
      : scene_(std::move(scene)),
        purpose_(purpose),
        n_(static_cast<std::size_t>(scene_->n())),
        model_(make_model<double>(scene_, std::span<const double>(scene_->default_parameters()))),
        workspace_(model_) {}

  void set_up(std::span<const double> parameters) noexcept override {
    model_ = make_model<double>(scene_, parameters);
  }

  void run(const double* psi_at, const double* psid_at, const double* input_at, double t,
           double* out) noexcept override {
    const std::span<const double> psi(psi_at, n_), psid(psid_at, n_), input(input_at, n_);
    switch (purpose_) {
      case Purpose::forward_dynamics:
        put(forward_dynamics<double>(model_, psi, psid, input, t, workspace_), out);
        break;
      case Purpose::mass_times:
        times_mass(psi, input_at, t, out);
        break;
      case Purpose::mass_matrix:
        put(mass_matrix<double>(model_, psi, t, workspace_), out);
        break;
      case Purpose::bias:
        put(bias<double>(model_, psi, psid, t, workspace_), out);
        break;
      case Purpose::inverse_dynamics:
        put(inverse_dynamics<double>(model_, psi, psid, input, t, workspace_), out);
        break;
      case Purpose::end_effector: {
        const auto& state = end_effector<double>(model_, psi, psid, input, t, workspace_);
        put(state.jacobian, put(state.acceleration, put(state.velocity, put(state.position, out))));
        break;
      }
      case Purpose::energy: {
        const Energy<double> energy = mixloop::energy<double>(model_, psi, psid, t, workspace_);
        out[0] = energy.kinetic;
        out[1] = energy.potential;
        break;
      }
      case Purpose::dynamics_and_mass_times:
        put(forward_dynamics<double>(model_, psi, psid, input, t, workspace_), out);
        times_mass(psi, input_at + n_, t, out + n_);
        break;
      case Purpose::linearisation:
        break;  // has no reference: see reference_routine
    }
  }

 private:
  void times_mass(std::span<const double> psi, const double* a, double t, double* out) noexcept {
    const Mat<double>& M = mass_matrix<double>(model_, psi, t, workspace_);
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      out[i] = 0.0;
      for (Eigen::Index j = 0; j < M.cols(); ++j) out[i] += M(i, j) * a[j];
    }
  }

  std::shared_ptr<const Scene> scene_;
  Purpose purpose_;
  std::size_t n_;
  Model<double> model_;
  Workspace<double> workspace_;
};

}  // namespace

std::unique_ptr<Routine> reference_routine(std::shared_ptr<const Scene> scene, Purpose purpose) {
  // The procedure evaluates; only its recording can be differentiated.
  if (purpose == Purpose::linearisation)
    return std::make_unique<Interpreter>(trace(scene, purpose, Tracing::literal));
  return std::make_unique<Reference>(std::move(scene), purpose);
}

}  // namespace mixloop
