// SPDX-License-Identifier: MIT
#pragma once

#include <any>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/program/status.hpp"

namespace mixloop {

/// The inputs of one evaluation; `input` holds what else the purpose takes (tau, psidd or a). What a purpose
/// doesn't take may be empty.
struct Arguments {
  std::span<const double> psi, psid, input;
  double t = 0.0;
};

/// A method whose whole steps stand in machine code beside forward dynamics (steps_text.hpp).
enum class StepsBy : std::uint8_t { rk4, leapfrog };
constexpr std::array kStepsBy{StepsBy::rk4, StepsBy::leapfrog};
inline const char* name_of(StepsBy method) { return method == StepsBy::rk4 ? "rk4" : "leapfrog"; }

/// An emitted function of such steps (source.hpp).
using Steps = void (*)(double* x, const double* input, double t, double h, int steps, const double* k);

using StepsOfEach = std::array<Steps, kStepsBy.size()>;

/// What one user of a routine keeps between evaluations.
struct Memory {
  std::vector<double> numbers;  ///< of a program: what its set-up left, and an interpreter's slots
  std::any procedure;           ///< of the reference
};

/// A program ready to run, interpreted or compiled, or the procedure itself. Constant: threads share it, each
/// with a Memory of its own.
class Routine {
 public:
  virtual ~Routine() = default;

  virtual Memory make_memory() const = 0;
  /// Runs the set-up part: once before the first evaluation, and again when a parameter changes.
  virtual void set_up(std::span<const double> parameters, Memory& memory) const noexcept = 0;
  /// Whether closures are solved within, from the last pose that was evaluated.
  virtual bool solves_closures() const { return false; }
  /// Writes the outputs. No allocation, lock or exception.
  void run(const Arguments& at, Memory& memory, double* outputs) const noexcept {
    if (code_ != nullptr)
      code_(at.psi.data(), at.psid.data(), at.input.data(), at.t, memory.numbers.data(), outputs);
    else
      work_out(at, memory, outputs);
  }
  /// Of forward dynamics: whether they come as whole steps of this method, too.
  bool has_steps(StepsBy method) const { return steps_[static_cast<std::size_t>(method)] != nullptr; }
  /// x = psi, psi' and the inputs' work goes on by `steps` steps of h s from t on, the inputs held.
  void go_on(StepsBy method, double* x, std::span<const double> input, double t, double h, int steps,
             const Memory& memory) const noexcept {
    steps_[static_cast<std::size_t>(method)](x, input.data(), t, h, steps, memory.numbers.data());
  }

 protected:
  /// An emitted evaluation (source.hpp).
  using Code = void (*)(const double* psi, const double* psid, const double* input, double t, const double* k,
                        double* outputs);
  Code code_ = nullptr;  ///< serves where there is one
  StepsOfEach steps_{};

 private:
  virtual void work_out(const Arguments&, Memory&, double*) const noexcept {}
};

/// A routine with a memory: what one thread evaluates. The routine must live on.
class Evaluator {
 public:
  Evaluator() = default;
  explicit Evaluator(const Routine& routine) : routine_(&routine), memory_(routine.make_memory()) {}

  explicit operator bool() const { return routine_ != nullptr; }
  bool solves_itself() const { return routine_->solves_closures(); }
  void set_up(std::span<const double> parameters) noexcept { routine_->set_up(parameters, memory_); }
  /// `outputs` is as long as what the routine gives.
  Status evaluate(const Arguments& at, std::span<double> outputs) noexcept {
    routine_->run(at, memory_, outputs.data());
    return status_of(outputs);
  }
  bool has_steps(StepsBy method) const { return routine_ != nullptr && routine_->has_steps(method); }
  void go_on(StepsBy method, std::span<double> x, std::span<const double> input, double t, double h,
             int steps) noexcept {
    routine_->go_on(method, x.data(), input, t, h, steps, memory_);
  }

 private:
  const Routine* routine_ = nullptr;
  Memory memory_;
};

}  // namespace mixloop
