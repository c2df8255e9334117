// SPDX-License-Identifier: MIT
#include "loop/cases.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "loop/base.hpp"
#include "loop/inputs.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostCases = 10'000;

/// A value that a case may give to an entry, and what it is called.
struct Choice {
  std::string name;
  NodePtr value;
};

/// `[0 kg, 2 kg]`, or with names of their own `{empty: 0 kg, full: 5 kg}`.
std::vector<Choice> choices_in(const Node::Entry& entry) {
  std::vector<Choice> choices;
  const Node& node = *entry.value;
  if (node.kind == Node::Kind::mapping)
    for (const auto& named : node.entries) choices.push_back({named.key, named.value});
  else
    for (const auto& item : items_of(entry.value, "the values of a case"))
      choices.push_back(
          {item->kind == Node::Kind::scalar ? item->text : fmt::format("#{}", choices.size() + 1), item});
  if (choices.empty())
    throw InputError("wrong_size", entry.place,
                     "no value for " + in_quotes(entry.key) + "; expected one or more");
  return choices;
}

/// The last step of an entry's path: `payload` of `parameters.payload`.
std::string short_name(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

std::vector<Case> cases_of(const std::filesystem::path& experiment) {
  const NodePtr document = on_base(read_document(experiment), experiment);
  const NodePtr node = document->kind == Node::Kind::mapping ? find_entry(*document, "cases") : nullptr;
  if (!node) return {};
  if (node->kind != Node::Kind::mapping)
    throw InputError("wrong_kind", node->place,
                     "the cases are " + describe(*node) +
                         "; expected entries and their values, e.g. {parameters.payload: [0 kg, 2 kg]}");
  std::vector<Case> cases(1);
  for (const auto& entry : node->entries) {
    std::vector<Case> more;
    for (const Case& before : cases)
      for (const Choice& choice : choices_in(entry)) {
        Case with = before;
        with.name +=
            fmt::format("{}{}={}", with.name.empty() ? "" : ", ", short_name(entry.key), choice.name);
        with.sets.push_back(entry.key + "=" + line_of(*choice.value));
        more.push_back(std::move(with));
      }
    if (more.size() > kMostCases)
      throw InputError("too_large", entry.place,
                       fmt::format("{} cases and more; expected {} at most", more.size(), kMostCases));
    cases = std::move(more);
  }
  std::vector<std::string> names;
  for (const Case& one : cases) names.push_back(one.name);
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
    throw InputError(
        "doubly_defined", node->place,
        "two cases are called " + in_quotes(*twice) + "; expected names of their own: {name: value, ...}");
  return cases;
}

Case case_named(const std::filesystem::path& experiment, const std::string& name) {
  const auto cases = cases_of(experiment);
  const auto found = std::ranges::find(cases, name, &Case::name);
  if (found != cases.end()) return *found;
  std::vector<std::string> names;
  std::string all;
  for (const Case& one : cases) {
    names.push_back(one.name);
    all += (all.empty() ? "" : "; ") + one.name;
  }
  throw InputError("unknown_value", {experiment.string()},
                   "no case " + in_quotes(name) + "; " +
                       (all.empty() ? "the experiment has no cases" : "expected one of: " + all) +
                       suggestion(name, names));
}

std::string name_with_case(const std::string& experiment, const std::string& name) {
  return name.empty() ? experiment : experiment + "[" + name + "]";
}

}  // namespace mixloop
