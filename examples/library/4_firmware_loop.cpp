// SPDX-License-Identifier: MIT
// A controller as firmware has it, no library in it: emitted C++, fixed arrays, a tick a call. The library's
// plant answers it; every command has the bits of the experiment's own controller.
//   mixloop compile scenes/mixed_loop_robot.yaml --emit cpp --purpose mass_times --file robot.cpp
//   4_firmware_loop experiments/paper.yaml
#include <cstdio>
#include <cstring>
#include <mixloop/mixloop.hpp>

extern "C" {
extern const int mixloop_mass_times_constants;
void mixloop_mass_times_set_up(const double* parameters, double* k);
void mixloop_mass_times(const double* psi, const double* psid, const double* input, double t, const double* k,
                        double* out);
}

namespace firmware {

constexpr double kKp[] = {100, 25, 25}, kKv[] = {1, 0.5, 0.5};
double constants[64];

bool start(double payload) {
  if (mixloop_mass_times_constants > 64) return false;
  mixloop_mass_times_set_up(&payload, constants);
  return true;
}

/// (33) tau = Kp (Psi_d - Psi) + Kv (Psi'_d - Psi') + M(Psi) Psi''_d
void tick(const double* psi, const double* psid, const double* psi_d, const double* psid_d,
          const double* psidd_d, double* tau) {
  double Ma[3];
  mixloop_mass_times(psi, psid, psidd_d, 0, constants, Ma);
  for (int i = 0; i < 3; ++i)
    tau[i] = (kKp[i] * (psi_d[i] - psi[i]) + kKv[i] * (psid_d[i] - psid[i])) + Ma[i];
}

}  // namespace firmware

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: %s EXPERIMENT\n", argv[0]), 2;
  const auto experiment = mixloop::Experiment::load(argv[1]);
  const mixloop::Plan plan(experiment);
  mixloop::Plant plant(experiment, plan);
  mixloop::Controller controller(experiment);
  if (!firmware::start(5)) return std::fprintf(stderr, "the firmware has too little memory\n"), 3;
  for (std::int64_t k = 0; k < plan.ticks(); ++k) {
    const auto now = plant.measured();
    const auto desired = plan.at(k);
    double tau[3], expected[3];
    firmware::tick(now.psi.data(), now.psid.data(), desired.psi.data(), desired.psid.data(),
                   desired.psidd.data(), tau);
    controller.torque(now, desired, expected);
    if (std::memcmp(tau, expected, sizeof tau) != 0)
      return std::fprintf(stderr, "tick %lld differs\n", static_cast<long long>(k)), 1;
    plant.advance(tau);
  }
  std::printf("%lld ticks, bit by bit the experiment's own controller\n",
              static_cast<long long>(plan.ticks()));
  return 0;
} catch (const mixloop::Error& error) {
  std::fprintf(stderr, "%s (%s)\n", error.what(), error.code().c_str());
  return 2;
}
