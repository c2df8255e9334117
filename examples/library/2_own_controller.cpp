// SPDX-License-Identifier: MIT
// The closed loop with a control law of one's own: errors die out as those of a critically damped oscillator
// of 20 rad/s, tau = M (psi''_d + 400 e + 40 e') + h. The paper's feeds M psi''_d alone forward.
//   2_own_controller experiments/paper.yaml
#include <cstdio>
#include <mixloop/result.hpp>
#include <vector>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: %s EXPERIMENT\n", argv[0]), 2;
  const auto experiment = mixloop::Experiment::load(argv[1]);
  mixloop::Equations model(experiment.scene(), {mixloop::Purpose::inverse_dynamics});
  std::vector<double> a(static_cast<std::size_t>(experiment.scene().n()));

  const auto law = [&](const mixloop::State& now, const mixloop::Reference& desired, std::span<double> tau) {
    for (std::size_t i = 0; i < tau.size(); ++i)
      a[i] = desired.psidd[i] + 400 * (desired.psi[i] - now.psi[i]) + 40 * (desired.psid[i] - now.psid[i]);
    model.evaluate(mixloop::Purpose::inverse_dynamics, now, a, tau);
  };
  const auto mine = mixloop::simulate(experiment, law), theirs = mixloop::simulate(experiment);
  std::printf("mine:   at most %.4f mm\n", mine.max_position_error * 1e3);
  std::printf("theirs: at most %.4f mm\n", theirs.max_position_error * 1e3);
  return mine.max_position_error < theirs.max_position_error ? 0 : 1;
} catch (const mixloop::Error& error) {
  std::fprintf(stderr, "%s (%s)\n", error.what(), error.code().c_str());
  return 2;
}
