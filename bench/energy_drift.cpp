// SPDX-License-Identifier: MIT
// The paper's robot let go at the path's start, without friction: how far its energy drifts, and what that
// costs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <optional>

#include "bench/machine.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "integrators/integrator.hpp"
#include "loop/experiment.hpp"

namespace mixloop::bench {
namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

class FreeRobot {
 public:
  FreeRobot() {
    const Experiment paper = load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / "paper.yaml", {});
    start_ = make_plan(paper).at(0).psi;
    dynamics_.emplace(
        equations_of(paper.scene, Evaluation::machine_code, {Purpose::forward_dynamics, Purpose::energy}),
        paper.parameters);
  }

  Vector start() const {
    Vector x = Vector::Zero(6);
    x.head(3) = start_;
    return x;
  }
  void rate(const Vector& x, Vector& dx) {
    dx.head(3) = x.tail(3);
    dynamics_->evaluate(Purpose::forward_dynamics, {{x.data(), 3}, {x.data() + 3, 3}, kNone},
                        {dx.data() + 3, 3});
  }
  /// Kinetic energy and the sum.
  std::array<double, 2> energy(const Vector& x) {
    double parts[2];
    dynamics_->evaluate(Purpose::energy, {.psi = {x.data(), 3}, .psid = {x.data() + 3, 3}}, parts);
    return {parts[0], parts[0] + parts[1]};
  }

 private:
  static constexpr double kNone[3] = {};
  Vector start_;
  std::optional<Equations::Workspace> dynamics_;
};

/// Steps of h on end, what they round away carried along; the drift is a share of the largest kinetic energy.
template <class Method>
void swing(const char* name, double h, double duration) {
  FreeRobot robot;
  Method method(3, 6);
  Vector x = robot.start(), carry = Vector::Zero(6);
  const double begin = robot.energy(x)[1];
  const auto steps = static_cast<std::int64_t>(std::llround(duration / h)), rows = std::int64_t{20};
  const auto rate = [&](int, double, const Vector& at, Vector& dx) { robot.rate(at, dx); };
  double kinetic = 0, worst = 0, last = 0;
  const double clock = cpu_seconds();
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t i = steps * row / rows; i < steps * (row + 1) / rows; ++i) {
      method.compensated_step(x, carry, h, rate);
      if (i % 64 != 0) continue;
      const auto [T, E] = robot.energy(x);
      kinetic = std::max(kinetic, T);
      worst = std::max(worst, std::abs(E - begin));
    }
    last = robot.energy(x)[1] - begin;
    std::printf("  %9.0f s  drift %+.2e  largest %.2e\n", static_cast<double>(row + 1) * duration / rows,
                last / kinetic, worst / kinetic);
    std::fflush(stdout);
  }
  const double seconds = cpu_seconds() - clock;
  std::printf("| %s | %g ms | %.0f s | %.1e | %.1e | %.1f s | %.0f |\n", name, h * 1e3, duration,
              std::abs(last) / kinetic, worst / kinetic, seconds, duration / seconds);
  std::fflush(stdout);
}

}  // namespace
}  // namespace mixloop::bench

int main(int argc, char** argv) {
  using namespace mixloop;
  using namespace mixloop::bench;
  const double duration = argc > 1 ? std::atof(argv[1]) : 1e6,
               h = argc > 3 ? std::atof(argv[3]) * 1e-3 : 4e-3;
  const char* method = argc > 2 ? argv[2] : "dop853";
  if (!(duration > 0 && h > 0)) {
    std::fprintf(
        stderr, "mixloop-bench-energy-drift [seconds [dop853|gauss8|gauss12|dormand_prince [step in ms]]]\n");
    return 2;
  }
  std::printf("%s\n", machine_description().c_str());
  std::printf("| method | step | time | drift at the end | largest | CPU time | faster than real |\n");
  if (std::strcmp(method, "gauss8") == 0)
    swing<Gauss<double, 4>>(method, h, duration);
  else if (std::strcmp(method, "gauss12") == 0)
    swing<Gauss<double, 6>>(method, h, duration);
  else if (std::strcmp(method, "dormand_prince") == 0)
    swing<DormandPrince<double>>(method, h, duration);
  else
    swing<Dop853<double>>(method, h, duration);
  return 0;
}
