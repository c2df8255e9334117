// SPDX-License-Identifier: MIT
// The peers' equations of the paper's robot: integrated by our methods, which is kinder to them than their
// own (fewer evaluations for the same error), and MuJoCo's own steps.
#include <array>
#include <memory>

#include "bench/engine.hpp"
#include "bench/work_precision.hpp"
#include "integrators/dop853.hpp"
#include "integrators/dormand_prince.hpp"
#include "integrators/leapfrog.hpp"
#include "integrators/rk4.hpp"

namespace mixloop::bench {
namespace {

/// The torque of a tick at a state.
class Driver {
 public:
  explicit Driver(const Case& problem) : case_(problem) {
    if (problem.drive != Case::Drive::closed_loop) return;
    plan_ = std::make_unique<Plan>(make_plan(problem.experiment));
    controller_ = std::make_unique<Controller>(make_controller(problem.experiment));
  }
  void operator()(int k, State& state) const {
    if (controller_)
      controller_->torque({state.psi, state.psid, k * case_.tick()}, plan_->at(k), state.tau);
    else
      case_.torque(k, state.tau);
  }

 private:
  const Case& case_;
  std::unique_ptr<Plan> plan_;
  std::unique_ptr<Controller> controller_;
};

State start_of(const Case& problem) {
  State state;
  std::copy_n(problem.psi0.begin(), 3, state.psi.begin());
  std::copy_n(problem.psid0.begin(), 3, state.psid.begin());
  return state;
}

template <class Tick>
Samples ticked(const Case& problem, const Driver& drive, const Tick& tick) {
  State state = start_of(problem);
  Samples samples;
  for (int k = 0; k < problem.ticks; ++k) {
    drive(k, state);
    tick(state);
    if ((k + 1) % problem.sample_every != 0) continue;
    samples.emplace_back(state.psi.begin(), state.psi.end());
    samples.back().insert(samples.back().end(), state.psid.begin(), state.psid.end());
  }
  return samples;
}

template <class Method>
Samples by_method(const Case& problem, const Driver& drive, const Engine& engine, int substeps) {
  Method method(3, 6);
  Vector x(6);
  const double h = problem.tick() / substeps;
  return ticked(problem, drive, [&](State& state) {
    std::copy_n(state.psi.begin(), 3, x.data());
    std::copy_n(state.psid.begin(), 3, x.data() + 3);
    method.begin();
    for (int step = 0; step < substeps; ++step)
      method.step(x, h, [&](int, double, const Vector& at, Vector& dx) {
        State now{.tau = state.tau};
        std::copy_n(at.data(), 3, now.psi.begin());
        std::copy_n(at.data() + 3, 3, now.psid.begin());
        Triple psidd;
        engine.forward(now, psidd);
        std::copy_n(at.data() + 3, 3, dx.data());
        std::copy_n(psidd.begin(), 3, dx.data() + 3);
      });
    std::copy_n(x.data(), 3, state.psi.begin());
    std::copy_n(x.data() + 3, 3, state.psid.begin());
  });
}

}  // namespace

void peer_points(const Case& problem, const Keep& keep) {
  Engines engines;
  add_textbook(engines);
  add_mujoco(engines);
  add_simbody(engines);
  const Driver drive(problem);
  for (const Engine& engine : engines)
    for (int substeps = 1; substeps <= (problem.name == "free" ? 8 : 4); substeps *= 2) {
      const std::string setting = "substeps " + std::to_string(substeps);
      const auto by = [&]<class Method>(const char* name) {
        keep(engine.name + ", by " + name, setting,
             [&] { return by_method<Method>(problem, drive, engine, substeps); });
      };
      by.operator()<Leapfrog<double>>("leapfrog");
      by.operator()<Rk4<double>>("rk4");
      by.operator()<DormandPrince<double>>("dormand_prince");
      by.operator()<Dop853<double>>("dop853");
      if (engine.own_tick)
        keep(engine.name + ", its own RK4", setting, [&] {
          return ticked(problem, drive,
                        [&](State& state) { engine.own_tick(state, problem.tick(), substeps); });
        });
    }
}

}  // namespace mixloop::bench
