// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

namespace mixloop {

/// Why a file that lies beside result.json is none of that run's, a sentence; empty where it is, or where
/// nothing tells. By its SHA-256, where the result has it (`files`), else by what kind of run it was.
std::string foreign_file(const nlohmann::ordered_json& result, const std::filesystem::path& file);

/// The same of a log, by the sessions that it has.
std::string foreign_log(const nlohmann::ordered_json& result, const std::filesystem::path& log,
                        const std::set<std::int64_t>& sessions);

/// The result.json in the folder where a file lies; null where there is none, or it is no result.
nlohmann::ordered_json result_beside(const std::filesystem::path& file);

}  // namespace mixloop
