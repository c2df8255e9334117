// SPDX-License-Identifier: MIT
#include "loop/base.hpp"

#include <algorithm>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostBases = 16;

std::shared_ptr<Node> copy_of(const Node& node) { return std::make_shared<Node>(node); }

NodePtr laid_over(const NodePtr& base, const NodePtr& top) {
  if (base->kind != Node::Kind::mapping || top->kind != Node::Kind::mapping) return top;
  auto merged = copy_of(*top);
  merged->entries = base->entries;
  for (const auto& entry : top->entries) {
    const auto known = std::ranges::find(merged->entries, entry.key, &Node::Entry::key);
    if (known == merged->entries.end())
      merged->entries.push_back(entry);
    else
      *known = {entry.key, entry.place, laid_over(known->value, entry.value)};
  }
  std::erase_if(merged->entries, [&](const Node::Entry& entry) {
    return entry.value->kind == Node::Kind::empty && find_entry(*base, entry.key);
  });
  return merged;
}

/// The mapping's entry `key`, if it is a text, as a path from `folder`.
NodePtr with_path_from(const NodePtr& mapping, std::string_view key, const std::filesystem::path& folder) {
  const NodePtr path = mapping->kind == Node::Kind::mapping ? find_entry(*mapping, key) : nullptr;
  if (!path || path->kind != Node::Kind::scalar) return mapping;
  auto moved = copy_of(*path);
  moved->text = (folder / path->text).string();
  moved->pieces.clear();
  auto changed = copy_of(*mapping);
  std::ranges::find(changed->entries, key, &Node::Entry::key)->value = moved;
  return changed;
}

NodePtr on_base(const NodePtr& document, const std::filesystem::path& file, std::size_t depth) {
  const NodePtr base = document->kind == Node::Kind::mapping ? find_entry(*document, "base") : nullptr;
  if (!base) return document;
  const std::filesystem::path steps = text_of(*base, "the path of an experiment file");
  const std::filesystem::path other = file.parent_path() / steps;
  std::error_code failure;
  if (!std::filesystem::is_regular_file(other, failure))
    throw InputError(
        "no_such_file", base->place,
        "no experiment at " + in_quotes(steps.string()) + " (its path counts from this file's folder)");
  if (depth == kMostBases)
    throw InputError("cyclic_definition", base->place,
                     "the experiment's base leads on through more than " + std::to_string(kMostBases) +
                         " files, or back to itself; expected a base that ends");
  const NodePtr below = as_read_from(on_base(read_document(other), other, depth + 1), steps.parent_path());
  if (below->kind != Node::Kind::mapping) return below;  // its reader refuses it
  auto merged = copy_of(*laid_over(below, document));
  std::erase_if(merged->entries, [](const Node::Entry& entry) { return entry.key == "base"; });
  return merged;
}

}  // namespace

NodePtr on_base(const NodePtr& document, const std::filesystem::path& file) {
  return on_base(document, file, 0);
}

NodePtr as_read_from(const NodePtr& document, const std::filesystem::path& steps) {
  const NodePtr changed = with_path_from(document, "scene", steps);
  const NodePtr controller =
      changed->kind == Node::Kind::mapping ? find_entry(*changed, "controller") : nullptr;
  if (!controller) return changed;
  auto result = copy_of(*changed);
  std::ranges::find(result->entries, "controller", &Node::Entry::key)->value =
      with_path_from(with_path_from(controller, "scene", steps), "file", steps);
  return result;
}

}  // namespace mixloop
