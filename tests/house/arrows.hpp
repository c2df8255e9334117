// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace mixloop {

/// Which rooms each room may include from: the table of docs/house.md, closed (what a room's own rooms know,
/// it knows). `all` stands for every room.
using Arrows = std::map<std::string, std::set<std::string>>;
Arrows arrows_of(const std::filesystem::path& page);

/// The includes below `root` that run against the arrows, `file:line: what`; also files in no room.
std::vector<std::string> includes_against(const Arrows& arrows, const std::filesystem::path& root);

}  // namespace mixloop
