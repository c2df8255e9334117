// SPDX-License-Identifier: MIT
// The project's own evaluations of scenes/mixed_loop_robot.yaml. The compiled programs go here as well.
#include <memory>

#include "bench/engine.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "dynamics/scene/load_scene.hpp"

namespace mixloop::bench {

void add_mixloop(Engines& engines) {
  const auto scene = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  const std::vector<double> parameters{kPayload};
  const auto model = std::make_shared<const Model<double>>(make_model<double>(scene, parameters));
  const auto workspace = std::make_shared<Workspace<double>>(*model);
  Engine reference;
  reference.name = "mixloop, reference procedure";
  reference.forward = [=](const State& state, Triple& psidd) {
    const auto& result = forward_dynamics<double>(*model, state.psi, state.psid, state.tau, 0.0, *workspace);
    psidd = {result[0], result[1], result[2]};
  };
  reference.mass = [=](const State& state, Symmetric& upper) {
    const auto& M = mass_matrix<double>(*model, state.psi, 0.0, *workspace);
    upper = {M(0, 0), M(0, 1), M(0, 2), M(1, 1), M(1, 2), M(2, 2)};
  };
  engines.push_back(std::move(reference));
}

}  // namespace mixloop::bench
