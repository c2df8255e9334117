// SPDX-License-Identifier: MIT
#include "dynamics/evaluator.hpp"

#include <cstdio>
#include <mutex>
#include <optional>

#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"

namespace mixloop {
namespace {

void say_once(const std::string& complaint) {
  static std::once_flag said;
  std::call_once(said, [&] {
    std::fprintf(stderr, "mixloop: programs are interpreted, not compiled: %s\n", complaint.c_str());
  });
}

std::unique_ptr<Routine> make_routine(const std::shared_ptr<const Scene>& scene, Purpose purpose,
                                      Evaluation& how) {
  if (how == Evaluation::reference) return reference_routine(scene, purpose);
  std::optional<Program> traced;
  const auto program = [&] {
    if (!traced) traced = trace(scene, purpose).program;
    return *traced;
  };
  if (how == Evaluation::machine_code) {
    std::string complaint;
    const std::string key = std::string(name_of(purpose)) + "\n" + scene->canonical;
    if (auto code = MachineCode::load(key, program, complaint)) return code;
    if (!complaint.empty()) say_once(complaint);
    how = Evaluation::interpreter;
  }
  return std::make_unique<Interpreter>(program());
}

}  // namespace

std::string_view name_of(Evaluation how) {
  return how == Evaluation::reference     ? "reference"
         : how == Evaluation::interpreter ? "interpreter"
                                          : "machine_code";
}

Dynamics::Dynamics(std::shared_ptr<const Scene> scene, std::span<const double> parameters, Evaluation how,
                   std::initializer_list<Purpose> purposes)
    : scene_(std::move(scene)), how_(how) {
  for (Purpose purpose : purposes) {
    Evaluation served = how;
    routines_[static_cast<std::size_t>(purpose)] = make_routine(scene_, purpose, served);
    if (served != how) how_ = served;
  }
  set_parameters(parameters);
}

Dynamics::~Dynamics() = default;
Dynamics::Dynamics(Dynamics&&) noexcept = default;
Dynamics& Dynamics::operator=(Dynamics&&) noexcept = default;

void Dynamics::set_parameters(std::span<const double> parameters) {
  for (auto& routine : routines_)
    if (routine) routine->set_up(parameters);
}

void Dynamics::forward_dynamics(std::span<const double> psi, std::span<const double> psid,
                                std::span<const double> tau, double t, std::span<double> psidd) noexcept {
  routine(Purpose::forward_dynamics).run(psi.data(), psid.data(), tau.data(), t, psidd.data());
}

void Dynamics::mass_times(std::span<const double> psi, std::span<const double> a, double t,
                          std::span<double> out) noexcept {
  routine(Purpose::mass_times).run(psi.data(), nullptr, a.data(), t, out.data());
}

void Dynamics::mass_matrix(std::span<const double> psi, double t, std::span<double> M) noexcept {
  routine(Purpose::mass_matrix).run(psi.data(), nullptr, nullptr, t, M.data());
}

void Dynamics::bias(std::span<const double> psi, std::span<const double> psid, double t,
                    std::span<double> h) noexcept {
  routine(Purpose::bias).run(psi.data(), psid.data(), nullptr, t, h.data());
}

void Dynamics::inverse_dynamics(std::span<const double> psi, std::span<const double> psid,
                                std::span<const double> psidd, double t, std::span<double> tau) noexcept {
  routine(Purpose::inverse_dynamics).run(psi.data(), psid.data(), psidd.data(), t, tau.data());
}

void Dynamics::end_effector(std::span<const double> psi, std::span<const double> psid,
                            std::span<const double> psidd, double t, std::span<double> out) noexcept {
  routine(Purpose::end_effector).run(psi.data(), psid.data(), psidd.data(), t, out.data());
}

void Dynamics::energy(std::span<const double> psi, std::span<const double> psid, double t,
                      std::span<double> out) noexcept {
  routine(Purpose::energy).run(psi.data(), psid.data(), nullptr, t, out.data());
}

void Dynamics::linearisation(std::span<const double> psi, std::span<const double> psid,
                             std::span<const double> tau, double t, std::span<double> out) noexcept {
  routine(Purpose::linearisation).run(psi.data(), psid.data(), tau.data(), t, out.data());
}

void Dynamics::dynamics_and_mass_times(std::span<const double> psi, std::span<const double> psid,
                                       std::span<const double> tau_and_a, double t,
                                       std::span<double> out) noexcept {
  routine(Purpose::dynamics_and_mass_times).run(psi.data(), psid.data(), tau_and_a.data(), t, out.data());
}

}  // namespace mixloop
