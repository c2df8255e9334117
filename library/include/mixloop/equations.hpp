// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <mixloop/scene.hpp>

namespace mixloop::v1 {

/// How equations are evaluated.
enum class Evaluation : std::uint8_t {
  reference,     ///< the procedure as it stands: the bits of `mixloop dynamics`
  interpreter,   ///< the scene's programs, interpreted
  machine_code,  ///< the same bits, compiled: needs a C++ compiler the first time, else interpreted
};

/// What is evaluated, of M(psi) psi'' + h(psi, psi') = tau: what it takes beside psi, psi' and t, and what it
/// gives. Matrices stand column by column; SI, radians.
enum class Purpose : std::uint8_t {
  forward_dynamics,  ///< tau (n_u) -> psi'' (n)
  mass_times,        ///< a (n_u) -> the motors' rows of M a (n_u), the free coordinates not accelerating
  mass_matrix,       ///< nothing -> M (n x n)
  bias,              ///< nothing -> h (n)
  inverse_dynamics,  ///< psi'' (n) -> M psi'' + h (n)
  end_effector,      ///< psi'' (n) -> position, velocity, acceleration (3 each), Jacobian (3 x n)
  energy,            ///< nothing -> kinetic energy, potential, J
  linearisation,     ///< tau (n_u) -> d psi''/d psi, d psi''/d psi' (n x n each), d psi''/d tau (n x n_u);
                     ///< not by Evaluation::reference
  dynamics_and_mass_times,  ///< tau, a (n_u each) -> psi'' (n), M a (n_u)
};

/// How an evaluation went.
enum class Status : std::uint8_t {
  ok,
  not_finite,  ///< the mass matrix is singular there, a spring's ends meet, or an argument is not finite
  not_closed,  ///< the mechanism doesn't reach so far, or a singular pose is on the way
};

/// Where a mechanism is. A view: who makes one keeps the numbers. An empty psid stands for zeros.
struct State {
  std::span<const double> psi;   ///< n, rad or m
  std::span<const double> psid;  ///< n, their rates
  double t = 0;                  ///< s
};

/// A scene's equations of motion, ready to evaluate for the purposes asked for. One thread at a time uses
/// one; a copy, which shares the programs, is another's.
class MIXLOOP_API Equations {
 public:
  /// Traces (and compiles, or finds compiled) the programs: takes up to seconds. Throws Error for what can't
  /// be evaluated.
  Equations(const Scene& scene, const std::vector<Purpose>& purposes,
            Evaluation how = Evaluation::machine_code);
  Equations(const Equations&);               ///< shares the programs, has the parameters
  Equations(Equations&&) noexcept;           ///< the other may only be assigned to or destroyed
  Equations& operator=(Equations) noexcept;  ///< copies or moves
  ~Equations();

  /// What serves: `interpreter` where a program could not be compiled.
  Evaluation evaluation() const;
  /// Why one could not; empty where all are as they were asked for, or too long to compile.
  const std::string& complaint() const;

  /// New values for the scene's parameters, in their order; from the start on they are the defaults.
  void set_parameters(std::span<const double> values);

  std::size_t input_size(Purpose purpose) const;   ///< how many numbers it takes beside the state
  std::size_t output_size(Purpose purpose) const;  ///< how many it gives

  /// One state. `input` (input_size) is what the purpose takes, empty for zeros; `out` (output_size) may not
  /// overlap it. Allocates nothing. Throws Error for a purpose that was not asked for ("not_asked_for") and
  /// for wrong sizes ("wrong_size").
  Status evaluate(Purpose purpose, const State& at, std::span<const double> input, std::span<double> out);

  /// `t.size()` states at once, their values one state after the other: psi and psid (n each; psid may be
  /// empty), input (input_size each; may be empty), out (output_size each). The bits are evaluate's; machine
  /// code takes as many states at once as the processor has lanes, and is compiled at a purpose's first call.
  /// `not_finite` where one of them is. Throws as evaluate does.
  Status evaluate_all(Purpose purpose, std::span<const double> psi, std::span<const double> psid,
                      std::span<const double> t, std::span<const double> input, std::span<double> out);

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// The programs as one C++17 file that needs only <math.h>, for firmware: for each purpose PREFIX_set_up,
/// PREFIX and PREFIX_constants, PREFIX being mixloop_PURPOSE (docs/compiler.md).
MIXLOOP_API std::string cpp_source(const Scene& scene, const std::vector<Purpose>& purposes);

}  // namespace mixloop::v1
