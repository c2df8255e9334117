// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "loop/output_folder.hpp"
#include "loop/recorder.hpp"

namespace mixloop {

/// Keeps a run: result.json, trajectory.csv and inputs.json. Throws RunFault("cannot_write").
void keep(const std::filesystem::path& folder, const Experiment& experiment, const Plan& plan,
          const Recorder& recorder, const nlohmann::json& result);

}  // namespace mixloop
