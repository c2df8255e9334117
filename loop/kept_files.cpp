// SPDX-License-Identifier: MIT
#include "loop/kept_files.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "loop/kept_json.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

std::string sha256_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  Sha256 hash;
  char buffer[1 << 16];
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0)
    hash.add(std::string_view(buffer, static_cast<std::size_t>(in.gcount())));
  return hash.hex();
}

std::string of_another_run(const std::filesystem::path& file, const std::string& why) {
  return fmt::format("{} is of another run than result.json beside it: {}.", file.filename().string(), why);
}

}  // namespace

std::string foreign_file(const nlohmann::ordered_json& result, const std::filesystem::path& file) {
  if (!result.is_object()) return "";
  const std::string name = file.filename().string();
  if (const auto files = result.find("files"); files != result.end() && files->is_object()) {
    if (!files->contains(name)) return of_another_run(file, "that one kept no such file");
    return (*files)[name] == sha256_of(file) ? ""
                                             : of_another_run(file, "its SHA-256 is not the one noted there");
  }
  const KeptJson kept(result, file.parent_path() / "result.json");
  if (name == "ages.csv" && kept.value<std::string>("route", "real_time") != "real_time")
    return of_another_run(file, "that one was not in real time");
  return "";
}

std::string foreign_log(const nlohmann::ordered_json& result, const std::filesystem::path& log,
                        const std::set<std::int64_t>& sessions) {
  // Of a stranger's plant a result has the log, and no session.
  if (!result.contains("verdict") || (!result.contains("session") && result.contains("log"))) return "";
  if (!result.contains("session")) return of_another_run(log, "that one was not over the bus");
  const auto session = KeptJson(result, log.parent_path() / "result.json").value<std::int64_t>("session");
  if (sessions.contains(session)) return "";
  return of_another_run(log, fmt::format("it has no session {}", session));
}

nlohmann::ordered_json result_beside(const std::filesystem::path& file) {
  std::ifstream in(file.parent_path() / "result.json");
  auto json = nlohmann::ordered_json::parse(in, nullptr, false);
  return json.is_object() ? json : nlohmann::ordered_json();
}

}  // namespace mixloop
