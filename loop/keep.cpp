// SPDX-License-Identifier: MIT
#include "loop/keep.hpp"

#include <fstream>

#include "loop/inputs.hpp"
#include "loop/trajectory.hpp"

namespace mixloop {

void keep(const std::filesystem::path& folder, const Experiment& experiment, const Plan& plan,
          const Recorder& recorder, const nlohmann::json& result) {
  write_trajectory(folder / "trajectory.csv", experiment, plan, recorder);
  keep_inputs(folder, experiment);
  std::ofstream out(folder / "result.json");
  out << result.dump(2) << '\n';
  if (!out.flush()) throw RunFault("cannot_write", "cannot write " + (folder / "result.json").string());
}

}  // namespace mixloop
