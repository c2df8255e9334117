// SPDX-License-Identifier: MIT
#include "processes/keep.hpp"

#include "loop/arrivals_file.hpp"
#include "loop/inputs.hpp"
#include "loop/output_file.hpp"
#include "loop/trajectory.hpp"
#include "notation/long_work.hpp"
#include "processes/result_json.hpp"

namespace mixloop {

void keep(const std::filesystem::path& folder, const RecordedPlant& run, Result& result) {
  const Uninterrupted whole;
  auto& files = result.files.emplace();
  if (result.run->route == "real_time")
    files["ages.csv"] = write_arrivals(folder / "ages.csv", run.deadlines().arrivals());
  files["trajectory.csv"] =
      write_trajectory(folder / "trajectory.csv", run.experiment(), run.plan(), run.recorder());
  files["inputs.json"] = keep_inputs(folder, run.experiment());
  keep_result(folder, result);
}

void keep_result(const std::filesystem::path& folder, const Result& result) {
  write_file(folder / "result.json", json_text(json_of(result), 2) + "\n");
}

}  // namespace mixloop
