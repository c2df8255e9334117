// SPDX-License-Identifier: MIT
#include "dynamics/scene/definitions.hpp"

#include <algorithm>
#include <map>

#include "notation/formula.hpp"

namespace mixloop {
namespace {

/// Depth-first; the path from the first definition to the one in hand is kept to name a cycle.
class Sorter {
 public:
  Sorter(const Node& mapping, std::string what, const std::function<void(const Node::Entry&)>& define)
      : what_(std::move(what)), define_(define) {
    for (const auto& entry : mapping.entries) entries_[entry.key] = &entry;
  }

  void visit(const Node::Entry& entry) {
    if (done_[entry.key]) return;
    const auto again = std::find(path_.begin(), path_.end(), entry.key);
    if (again != path_.end()) {
      std::string cycle;
      for (auto name = again; name != path_.end(); ++name) cycle += *name + " -> ";
      throw InputError("cyclic_definition", entry.place,
                       what_ + " defined by themselves: " + cycle + entry.key);
    }
    if (path_.size() > 500)
      throw InputError("too_deep", entry.place, what_ + " that refer to each other more than 500 deep");
    path_.push_back(entry.key);
    for (const auto& name : names_in(text_of(*entry.value, "a formula for '" + entry.key + "'")))
      if (const auto other = entries_.find(name); other != entries_.end()) visit(*other->second);
    path_.pop_back();
    done_[entry.key] = true;
    define_(entry);
  }

 private:
  std::string what_;
  const std::function<void(const Node::Entry&)>& define_;
  std::map<std::string, const Node::Entry*> entries_;
  std::map<std::string, bool> done_;
  std::vector<std::string> path_;
};

}  // namespace

void define_in_order(const Node& mapping, const std::string& what,
                     const std::function<void(const Node::Entry&)>& define) {
  Sorter sorter(mapping, what, define);
  for (const auto& entry : mapping.entries) sorter.visit(entry);
}

}  // namespace mixloop
