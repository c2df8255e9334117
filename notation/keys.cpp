// SPDX-License-Identifier: MIT
#include "notation/keys.hpp"

#include <algorithm>

namespace mixloop {

Mapping read_mapping(NodePtr node, const Keys& keys) {
  std::vector<std::string> names;
  for (const Key& key : keys.all) names.push_back(key.name);
  return {std::move(node), keys.what, std::move(names)};
}

const std::vector<std::string>& words_of(const Keys& keys, std::string_view name) {
  return std::ranges::find(keys.all, name, &Key::name)->form.words;
}

}  // namespace mixloop
