// SPDX-License-Identifier: MIT
// How strong the motors must be for a path, by payload: inverse dynamics at all its ticks, in lanes.
//   3_payload_sweep experiments/paper.yaml
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mixloop/experiment.hpp>
#include <vector>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: %s EXPERIMENT\n", argv[0]), 2;
  const auto experiment = mixloop::Experiment::load(argv[1]);
  const mixloop::Plan plan(experiment);
  std::vector<double> psi, psid, psidd, t;
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    const auto at = plan.at(k);
    psi.insert(psi.end(), at.psi.begin(), at.psi.end());
    psid.insert(psid.end(), at.psid.begin(), at.psid.end());
    psidd.insert(psidd.end(), at.psidd.begin(), at.psidd.end());
    t.push_back(static_cast<double>(k) / experiment.rate());
  }

  mixloop::Equations equations(experiment.scene(), {mixloop::Purpose::inverse_dynamics});
  const auto motors = static_cast<std::size_t>(experiment.scene().n());
  std::vector<double> tau(psi.size());
  double before = 0;
  bool grows = true;
  for (int kg = 0; kg <= 5; ++kg) {
    equations.set_parameters(std::vector<double>{static_cast<double>(kg)});
    equations.evaluate_all(mixloop::Purpose::inverse_dynamics, psi, psid, t, psidd, tau);
    std::printf("%d kg:", kg);
    double largest = 0;
    for (std::size_t i = 0; i < motors; ++i) {
      double peak = 0;
      for (std::size_t k = i; k < tau.size(); k += motors) peak = std::max(peak, std::abs(tau[k]));
      std::printf(" %.4f", peak);
      largest = std::max(largest, peak);
    }
    std::printf(" N m\n");
    grows = grows && largest > before;
    before = largest;
  }
  return grows ? 0 : 1;
} catch (const mixloop::Error& error) {
  std::fprintf(stderr, "%s (%s)\n", error.what(), error.code().c_str());
  return 2;
}
