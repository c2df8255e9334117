// SPDX-License-Identifier: MIT
#include "import/scene_names.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "dynamics/scene/draft.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLongestName = 64;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_word(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

bool is_symbol(const std::string& name) {
  try {
    check_symbol_name(name, {});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// The name with a number behind it where it is taken.
std::string untaken(std::string name, const std::set<std::string>& taken) {
  if (!taken.contains(name)) return name;
  for (int number = 2;; ++number) {
    const std::string tail = "_" + std::to_string(number);
    std::string other = name.substr(0, kLongestName - tail.size()) + tail;
    if (!taken.contains(other)) return other;
  }
}

std::string symbol_of(const std::string& said) {
  if (is_symbol(said)) return said;
  std::string name;
  for (const char c : said)
    if (is_word(c))
      name += c;
    else if (name.empty() || name.back() != '_')
      name += '_';
  if (name.empty() || !is_letter(name.front())) name.insert(0, name.starts_with('_') ? "joint" : "joint_");
  name.resize(std::min(name.size(), kLongestName));
  return is_symbol(name) ? name : name.substr(0, kLongestName - 6) + "_joint";  // a unit, a function
}

/// A text on one line.
std::string frame_of(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '_');
  return name == "0" ? "link_0" : name;
}

}  // namespace

SceneNames names_in_scene(const Robot& robot) {
  SceneNames names;
  std::set<std::string> frames = {"0"}, symbols;
  for (const auto& joint : robot.joints)  // names that may stay do, whatever others would become
    if (is_symbol(joint.name)) symbols.insert(joint.name);
  for (const auto& joint : robot.joints) {
    names.joints.push_back(is_symbol(joint.name) ? joint.name : untaken(symbol_of(joint.name), symbols));
    symbols.insert(names.joints.back());
    if (names.joints.back() != joint.name && joint.moves())
      names.renamed.emplace_back(joint.name, names.joints.back());
  }
  for (const auto& link : robot.links) {
    names.frames.push_back(link.joint < 0 ? "0" : untaken(frame_of(link.name), frames));
    frames.insert(names.frames.back());
    if (link.joint >= 0 && names.frames.back() != link.name)
      names.renamed.emplace_back(link.name, names.frames.back());
  }
  return names;
}

std::string file_name_of(const std::string& text) {
  std::string name;
  for (const char c : text) name += is_word(c) || c == '-' || (c == '.' && !name.empty()) ? c : '_';
  name.resize(std::min(name.size(), kLongestName));
  return name.empty() ? "robot" : name;
}

}  // namespace mixloop
