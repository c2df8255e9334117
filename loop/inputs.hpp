// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "loop/experiment.hpp"

namespace mixloop {

/// A document as JSON: scalars are strings, as they were written, so that it reads back by parse_document.
nlohmann::ordered_json json_of(const Node& node);
/// The same in a line of text.
std::string line_of(const Node& node);

/// What a run was started from, overrides applied: {"name", "rate", "experiment", "scene",
/// "limits", "faults", "plant_parameters"}. The documents read back (JSON is YAML); limits and faults are
/// what they come to, in SI and in words.
nlohmann::ordered_json inputs_json(const Experiment& experiment);

/// Writes inputs.json into the folder; its SHA-256. Throws RunFault("cannot_write").
std::string keep_inputs(const std::filesystem::path& folder, const Experiment& experiment);

}  // namespace mixloop
