// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/program/routine.hpp"
#include "dynamics/purpose.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// How the equations of motion are evaluated.
enum class Evaluation : std::uint8_t {
  reference,     ///< the procedure as it stands, on doubles
  interpreter,   ///< the scene's programs, interpreted
  machine_code,  ///< the scene's programs, compiled; interpreted where there is no compiler, and those too
                 ///< long to compile (kMostCompiledOperations)
};

/// `reference`, `interpreter`, `machine_code`.
std::string_view name_of(Evaluation how);

/// A scene's equations of motion, ready to evaluate for the purposes asked for.
///
/// Holds the memory that an evaluation needs: an object belongs to one thread. Evaluations do not
/// allocate, lock or throw. Spans are as long as purpose.hpp says, matrices column by column, in SI units;
/// outputs may not overlap inputs. A purpose that was not asked for at construction may not be evaluated.
class Dynamics {
 public:
  /// Traces (and compiles, or finds compiled) the programs. Throws InputError for a scene whose constraints
  /// cannot be evaluated.
  Dynamics(std::shared_ptr<const Scene> scene, std::span<const double> parameters, Evaluation how,
           std::initializer_list<Purpose> purposes);
  ~Dynamics();
  Dynamics(Dynamics&&) noexcept;
  Dynamics& operator=(Dynamics&&) noexcept;

  const Scene& scene() const { return *scene_; }
  int n() const { return scene_->n(); }
  /// What serves; `interpreter` where machine code was asked for and at least one program is interpreted.
  Evaluation evaluation() const { return how_; }

  /// Runs the set-up programs: new values for the scene's parameters.
  void set_parameters(std::span<const double> parameters);

  /// psidd = M^-1 (tau - h); not finite where M is singular.
  void forward_dynamics(std::span<const double> psi, std::span<const double> psid,
                        std::span<const double> tau, double t, std::span<double> psidd) noexcept;
  /// M a.
  void mass_times(std::span<const double> psi, std::span<const double> a, double t,
                  std::span<double> out) noexcept;
  /// M, n x n.
  void mass_matrix(std::span<const double> psi, double t, std::span<double> M) noexcept;
  /// h.
  void bias(std::span<const double> psi, std::span<const double> psid, double t,
            std::span<double> h) noexcept;
  /// tau = M psidd + h.
  void inverse_dynamics(std::span<const double> psi, std::span<const double> psid,
                        std::span<const double> psidd, double t, std::span<double> tau) noexcept;
  /// Position, velocity, acceleration (3 each), Jacobian (3 x n).
  void end_effector(std::span<const double> psi, std::span<const double> psid, std::span<const double> psidd,
                    double t, std::span<double> out) noexcept;
  /// Kinetic energy and potential.
  void energy(std::span<const double> psi, std::span<const double> psid, double t,
              std::span<double> out) noexcept;
  /// d psidd / d psi, d psidd / d psid, d psidd / d tau, n x n each.
  void linearisation(std::span<const double> psi, std::span<const double> psid, std::span<const double> tau,
                     double t, std::span<double> out) noexcept;
  /// psidd and M a from one program; `tau_and_a` has both, 2 n, and so has `out`.
  void dynamics_and_mass_times(std::span<const double> psi, std::span<const double> psid,
                               std::span<const double> tau_and_a, double t, std::span<double> out) noexcept;

 private:
  Routine& routine(Purpose purpose) noexcept { return *routines_[static_cast<std::size_t>(purpose)]; }

  std::shared_ptr<const Scene> scene_;
  Evaluation how_;
  std::array<std::unique_ptr<Routine>, kPurposes.size()> routines_;
};

}  // namespace mixloop
