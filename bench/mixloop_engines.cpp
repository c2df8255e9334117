// SPDX-License-Identifier: MIT
// The project's own evaluations of scenes/mixed_loop_robot.yaml; its payload is a parameter.
#include <memory>
#include <utility>

#include "bench/engine.hpp"
#include "dynamics/evaluator.hpp"
#include "dynamics/scene/load_scene.hpp"

namespace mixloop::bench {
namespace {

Engine engine(const std::shared_ptr<const Scene>& scene, Evaluation how) {
  const std::vector<double> parameters{kPayload};
  const auto dynamics = std::make_shared<Dynamics>(
      scene, parameters, how,
      std::initializer_list<Purpose>{Purpose::forward_dynamics, Purpose::mass_matrix, Purpose::mass_times,
                                     Purpose::dynamics_and_mass_times});
  Engine made;
  made.name = "mixloop, " + std::string(name_of(dynamics->evaluation()));
  made.forward = [dynamics](const State& state, Triple& psidd) {
    dynamics->forward_dynamics(state.psi, state.psid, state.tau, 0.0, psidd);
  };
  made.mass = [dynamics](const State& state, Symmetric& upper) {
    std::array<double, 9> M;
    dynamics->mass_matrix(state.psi, 0.0, M);
    upper = {M[0], M[3], M[6], M[4], M[7], M[8]};
  };
  made.mass_times = [dynamics](const State& state, Triple& force) {
    dynamics->mass_times(state.psi, state.tau, 0.0, force);
  };
  made.forward_and_mass_times = [dynamics](const State& state, Triple& psidd, Triple& force) {
    std::array<double, 6> in, out;
    for (std::size_t k = 0; k < 3; ++k) in[k] = in[k + 3] = state.tau[k];
    dynamics->dynamics_and_mass_times(state.psi, state.psid, in, 0.0, out);
    for (std::size_t k = 0; k < 3; ++k) psidd[k] = out[k], force[k] = out[k + 3];
  };
  return made;
}

}  // namespace

void add_mixloop(Engines& engines) {
  const auto scene = std::make_shared<const Scene>(
      load_scene(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml"));
  for (const Evaluation how : {Evaluation::machine_code, Evaluation::interpreter, Evaluation::reference})
    engines.push_back(engine(scene, how));
}

}  // namespace mixloop::bench
