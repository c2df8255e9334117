// SPDX-License-Identifier: MIT
#include "processes/keep.hpp"

#include <fstream>

#include "loop/inputs.hpp"
#include "loop/trajectory.hpp"
#include "notation/long_work.hpp"
#include "processes/result_json.hpp"

namespace mixloop {

void keep(const std::filesystem::path& folder, const RecordedPlant& run, const Result& result) {
  const Uninterrupted whole;
  write_trajectory(folder / "trajectory.csv", run.experiment(), run.plan(), run.recorder());
  keep_inputs(folder, run.experiment());
  keep_result(folder, result);
}

void keep_result(const std::filesystem::path& folder, const Result& result) {
  std::ofstream out(folder / "result.json");
  out << json_of(result).dump(2) << '\n';
  if (!out.flush()) throw RunFault("cannot_write", "cannot write " + (folder / "result.json").string());
}

}  // namespace mixloop
