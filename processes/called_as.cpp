// SPDX-License-Identifier: MIT
#include "processes/called_as.hpp"

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>

namespace mixloop {
namespace {

namespace fs = std::filesystem;

/// What a shell finds by this name; empty where nothing.
fs::path found_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  std::error_code failed;
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / name; !folder.empty() && fs::is_regular_file(file, failed))
      return fs::canonical(file, failed);
  return {};
}

/// From the folder where the person stands, or in full, whichever is shorter.
std::string from_here(const fs::path& file) {
  std::error_code failed;
  const std::string full = file.string(), near = fs::relative(file, failed).string();
  return failed || near.empty() || near.size() > full.size() ? full : near;
}

std::string own_call() {
  const fs::path own = fs::path(own_folder()) / "mixloop";
  return found_in_path("mixloop") == own ? "mixloop" : from_here(own);
}

/// `text` with what `named(match)` gives in place of each match of `pattern`.
template <class Named>
std::string replaced(const std::string& text, const std::regex& pattern, const Named& named) {
  std::string result;
  auto rest = text.begin();
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    result.append(rest, (*at)[0].first).append(named(*at));
    rest = (*at)[0].second;
  }
  return result.append(rest, text.end());
}

}  // namespace

std::string own_folder() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  const std::string parts = "/" MIXLOOP_LIBDIR "/mixloop", where = folder.string();
  return where.ends_with(parts) ? where.substr(0, where.size() - parts.size()) + "/" MIXLOOP_BINDIR : where;
}

std::string part(const std::string& name) {
  return (fs::path(own_folder()) / ".." / MIXLOOP_LIBDIR / "mixloop" / name).lexically_normal().string();
}

std::string shared_file(const std::string& name) { return own_folder() + "/../share/mixloop/" + name; }

std::string as_called(const std::string& text) {
  static const std::regex command("\\bmixloop(?= [a-z]+\\b)");
  static const std::regex shipped("\\b(experiments|scenes|docs)/((\\w+|\\*)\\.(yaml|md))\\b");
  const auto calls = replaced(text, command, [](const auto&) { return own_call(); });
  return replaced(calls, shipped, [](const std::smatch& match) {
    std::error_code failed;
    const std::string folder = match[1] == "docs" ? "../doc/mixloop/docs" : match[1].str();
    const fs::path installed = fs::weakly_canonical(shared_file(folder), failed);
    const bool here = fs::exists(match[1].str(), failed), there = fs::exists(installed, failed);
    return here || !there ? match[0].str() : (installed / match[2].str()).string();
  });
}

}  // namespace mixloop
