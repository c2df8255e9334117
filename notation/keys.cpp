// SPDX-License-Identifier: MIT
#include "notation/keys.hpp"

#include <algorithm>

namespace mixloop {
namespace {

void require_one_of(const Mapping& mapping, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "'" : " or '") + name + "'";
  const std::string* found = nullptr;
  for (const auto& name : names) {
    if (!mapping.has(name)) continue;
    if (found != nullptr)
      throw InputError("doubly_defined", mapping.at(name)->place,
                       mapping.what() + " has both '" + *found + "' and '" + name +
                           "'; expected one of them (`" + *found + ": ~` drops a base's)");
    found = &name;
  }
  if (found == nullptr)
    throw InputError("missing_key", mapping.node().place, mapping.what() + " lacks " + all);
}

}  // namespace

Mapping read_mapping(NodePtr node, const Keys& keys) {
  std::vector<std::string> names;
  for (const Key& key : keys.all) names.push_back(key.name);
  Mapping mapping(std::move(node), keys.what, std::move(names));
  require_one_of(mapping, keys.either);
  return mapping;
}

const std::vector<std::string>& words_of(const Keys& keys, std::string_view name) {
  return std::ranges::find(keys.all, name, &Key::name)->form.words;
}

}  // namespace mixloop
