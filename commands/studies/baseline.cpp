// SPDX-License-Identifier: MIT
#include "commands/studies/baseline.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "loop/output_file.hpp"

namespace mixloop {
namespace {

/// By name; what was never measured isn't there.
std::map<std::string, double> measured_in(const Measures& measures) {
  std::map<std::string, double> all = {{"max_position_error", measures.max_position_error},
                                       {"final_position_error", measures.final_position_error},
                                       {"rms_position_error", measures.rms_position_error}};
  if (measures.energy_drift) all["energy_drift"] = *measures.energy_drift;
  for (Eigen::Index i = 0; i < measures.max_torque.size(); ++i)
    all[fmt::format("max_torque[{}]", i)] = measures.max_torque[i];
  std::erase_if(all, [](const auto& one) { return !std::isfinite(one.second); });
  return all;
}

}  // namespace

Baseline::Baseline(std::string file) : file_(std::move(file)) {
  if (!std::filesystem::exists(file_)) return;
  try {
    std::ifstream in(file_);
    runs_ = nlohmann::json::parse(in).get<std::map<std::string, Measured>>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        "not_a_baseline", {file_},
        fmt::format("is no baseline of mixloop track: {}; expected the file that an earlier run kept, or "
                    "none",
                    error.what()));
  }
}

std::vector<std::string> Baseline::worse(const Result& result, double part) const {
  std::vector<std::string> lines;
  const auto before = runs_.find(result.experiment);
  if (before == runs_.end() || !result.run) return lines;
  const Measured now = measured_in(result.run->measures);
  for (const auto& [name, value] : before->second) {
    const auto found = now.find(name);
    if (found == now.end())
      lines.push_back(fmt::format("{} was not measured; last time it was {:.6g}", name, value));
    else if (found->second > value * (1 + part))
      lines.push_back(fmt::format("{} is {:.6g}; last time it was {:.6g}, expected at most {:g} % more", name,
                                  found->second, value, 100 * part));
  }
  return lines;
}

void Baseline::keep(std::span<const Result> results) {
  for (const Result& result : results)
    if (result.run) runs_[result.experiment] = measured_in(result.run->measures);
  write_file(file_, nlohmann::json(runs_).dump(2) + "\n");
}

}  // namespace mixloop
