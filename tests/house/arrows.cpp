// SPDX-License-Identifier: MIT
#include "tests/house/arrows.hpp"

#include <fstream>
#include <regex>

namespace mixloop {
namespace {

/// The names in back quotes of a cell.
std::vector<std::string> names_in(const std::string& cell) {
  static const std::regex quoted("`([a-z_/]+)`");
  std::vector<std::string> names;
  for (std::sregex_iterator at(cell.begin(), cell.end(), quoted), end; at != end; ++at) {
    std::string name = (*at)[1];
    if (name.back() == '/') name.pop_back();
    names.push_back(name);
  }
  return names;
}

/// The deepest room that a file stands in; empty where there is none.
std::string room_of(const Arrows& arrows, std::filesystem::path file) {
  while (file.has_parent_path()) {
    file = file.parent_path();
    if (arrows.contains(file.generic_string())) return file.generic_string();
  }
  return {};
}

void close(Arrows& arrows) {
  for (bool grew = true; grew;) {
    grew = false;
    for (auto& [room, known] : arrows) {
      const std::size_t before = known.size();
      for (const std::string& other : std::set<std::string>(known))
        if (const auto found = arrows.find(other); found != arrows.end())
          known.insert(found->second.begin(), found->second.end());
      grew = grew || known.size() > before;
    }
  }
}

}  // namespace

Arrows arrows_of(const std::filesystem::path& page) {
  static const std::regex row(R"(\| (`[^|]*) \|[^|]*\| ([^|]*) \|)");
  Arrows arrows;
  std::ifstream in(page);
  for (std::string line; std::getline(in, line);) {
    std::smatch cells;
    if (!std::regex_match(line, cells, row)) continue;
    const auto known = names_in(cells[2]);
    for (const std::string& room : names_in(cells[1])) {
      arrows[room].insert(known.begin(), known.end());
      if (cells[2] == "all") arrows[room].insert("all");
    }
  }
  close(arrows);
  return arrows;
}

std::vector<std::string> includes_against(const Arrows& arrows, const std::filesystem::path& root) {
  static const std::regex include(R"re(\s*#include "([^"]+)".*)re");
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::filesystem::path file = entry.path().lexically_relative(root);
    const std::string top = file.begin()->string(), kind = file.extension();
    if (top == "build" || top.starts_with('.') || (kind != ".cpp" && kind != ".hpp")) continue;
    const std::string room = room_of(arrows, file);
    if (room.empty()) found.push_back(file.string() + ": stands in no room of docs/house.md");
    std::ifstream in(entry.path());
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      std::smatch name;
      if (room.empty() || !std::regex_match(line, name, include)) continue;
      const std::string other = room_of(arrows, name[1].str());
      const auto& known = arrows.at(room);
      if (other.empty() || other == room || known.contains(other) || known.contains("all")) continue;
      found.push_back(file.string() + ":" + std::to_string(number) + ": " + room + " doesn't know " + other +
                      " (" + name[1].str() + ")");
    }
  }
  return found;
}

}  // namespace mixloop
