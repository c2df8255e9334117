// SPDX-License-Identifier: MIT
// A scene file; where it loads, its procedure is evaluated once.
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "tests/fuzz/check.hpp"

namespace {

using namespace mixloop;

void evaluate_once(std::shared_ptr<const Scene> scene) {
  const std::vector<double> parameters = scene->default_parameters();
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  Workspace<double> workspace(model);
  const std::vector<double>& psi = scene->home;
  const std::vector<double> ones(psi.size(), 1.0);
  mass_matrix<double>(model, psi, 0.0, workspace);
  inverse_dynamics<double>(model, psi, ones, ones, 0.0, workspace);
  forward_dynamics<double>(model, psi, ones, ones, 0.0, workspace);
  end_effector<double>(model, psi, ones, ones, 0.0, workspace);
  energy<double>(model, psi, ones, 0.0, workspace);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  refuses_or_reads("fuzz", [&] {
    evaluate_once(std::make_shared<const Scene>(load_scene(parse_document(text_of(data, size), "fuzz"))));
  });
  return 0;
}
