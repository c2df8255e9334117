// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "notation/errors.hpp"

namespace mixloop {

/// What of a robot isn't carried over, by kinds.
class LeftBehind {
 public:
  struct Kind {
    std::string what;                ///< e.g. "meshes of the links"
    std::vector<std::string> names;  ///< whose
    Place place;                     ///< of the first
  };

  void add(const std::string& what, const std::string& name, const Place& place);
  const std::vector<Kind>& kinds() const { return kinds_; }

 private:
  std::vector<Kind> kinds_;
  std::map<std::string, std::size_t> index_;              ///< of a kind by what it is
  std::set<std::pair<std::size_t, std::string>> listed_;  ///< which names it has
};

/// "meshes of the links: base, arm"
std::string text_of(const LeftBehind::Kind& kind);

class XmlFile;
struct Robot;

/// Lists what of the file has no place in a scene: elements that mean nothing there, motions that are held,
/// friction, shapes.
void list_left_behind(const XmlFile& file, const Robot& robot, LeftBehind& left);

}  // namespace mixloop
