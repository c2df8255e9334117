// SPDX-License-Identifier: MIT
#include "sweep/request.hpp"

#include <algorithm>

#include "loop/experiment_keys.hpp"
#include "loop/inputs.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

const std::vector<Node::Entry>& entries_of(const NodePtr& node, const char* what) {
  if (node->kind != Node::Kind::mapping)
    throw InputError("wrong_kind", node->place,
                     "found " + describe(*node) + "; expected " + what + " as a mapping of keys");
  return node->entries;
}

ShareBound read_bound(const NodePtr& node) {
  const Mapping entry = read_mapping(node, sweep_expectation_keys());
  ShareBound bound{.place = node->place};
  if (const NodePtr share = entry.find("share")) {
    bound.share = number_of(*share, kPure, "the share");
    if (!(bound.share > 0 && bound.share <= 1))
      throw InputError("out_of_range", share->place,
                       "the share is " + in_quotes(share->text) + "; expected more than 0, and 1 at most");
  }
  auto expected = std::make_shared<Node>(*node);
  std::erase_if(expected->entries, [](const Node::Entry& one) { return one.key == "share"; });
  bound.expected = expected;
  return bound;
}

std::vector<Override> read_set(const NodePtr& node) {
  std::vector<Override> overrides;
  for (const auto& entry : entries_of(node, "what is set"))
    overrides.push_back({entry.key, line_of(*entry.value)});
  return overrides;
}

}  // namespace

const Keys& sweep_expectation_keys() {
  static const Keys keys = [] {
    Keys all = expectation_keys();
    all.what = "what is expected of a share of the runs";
    all.all.insert(all.all.begin(), {"share", form::number()});
    return all;
  }();
  return keys;
}

const Keys& sweep_keys() {
  static const Keys keys{"the sweep",
                         {{"experiment", form::text(), kRequired},
                          {"set", form::named(form::any())},
                          {"vary", form::named(form::any())},
                          {"sample", form::named(form::text())},
                          {"runs", form::whole()},
                          {"design", form::word(spread_names())},
                          {"seed", form::whole()},
                          {"settled_within", form::number()},
                          {"expect", form::list(form::mapping(sweep_expectation_keys))}}};
  return keys;
}

const std::vector<std::string>& spread_names() {
  static const std::vector<std::string> names = {"grid", "latin", "sobol", "random"};
  return names;
}

std::optional<Spread> spread_named(const std::string& name) {
  const auto at = std::ranges::find(spread_names(), name) - spread_names().begin();
  if (at == 0) return std::nullopt;
  return static_cast<Spread>(at - 1);
}

bool is_sweep(const std::filesystem::path& file) {
  try {
    const NodePtr document = read_document(file);
    return document->kind == Node::Kind::mapping && find_entry(*document, "experiment");
  } catch (const InputError&) {
    return false;
  }
}

std::string name_of_sweep(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  static constexpr std::string_view kSuffix = ".sweep";
  if (name.ends_with(kSuffix)) name.resize(name.size() - kSuffix.size());
  return printable_name(name);
}

SweepRequest read_sweep(const std::filesystem::path& file) {
  const Mapping root = read_mapping(read_document(file), sweep_keys());
  SweepRequest request;
  const NodePtr experiment = root.at("experiment");
  request.experiment = file.parent_path() / text_of(*experiment, "the path of an experiment file");
  std::error_code failure;
  if (!std::filesystem::is_regular_file(request.experiment, failure))
    throw InputError(
        "no_such_file", experiment->place,
        "no experiment at " + describe(*experiment) + " (its path counts from this file's folder)");
  Design::Settings& design = request.design;
  if (const NodePtr set = root.find("set")) request.overrides = read_set(set);
  if (const NodePtr vary = root.find("vary"))
    for (const auto& entry : entries_of(vary, "what is varied")) design.varied.push_back(read_varied(entry));
  if (const NodePtr sample = root.find("sample"))
    for (const auto& entry : entries_of(sample, "what is sampled"))
      design.sampled.push_back(read_sampled(entry));
  if (const NodePtr runs = root.find("runs")) {
    design.draws = whole_number_of(*runs, 1, 1L << 40, "the number of runs");
    request.draws_given = true;
  }
  if (const NodePtr spread = root.find("design")) {
    const auto named = spread_named(spread_names()[word_of(*spread, spread_names(), "the design")]);
    if (named) design.spread = *named;
    request.spread_given = named.has_value();
  }
  if (const NodePtr seed = root.find("seed"))
    design.seed = static_cast<std::uint64_t>(whole_number_of(*seed, 0, 1L << 53, "the seed"));
  if (const NodePtr within = root.find("settled_within"))
    request.settled_within = number_of(*within, kLength, "what counts as settled");
  if (const NodePtr expect = root.find("expect"))
    for (const auto& item : items_of(expect, "what is expected of shares of the runs"))
      request.expect.push_back(read_bound(item));
  return request;
}

void require_samples(const SweepRequest& request) {
  if (!request.design.sampled.empty() || !(request.draws_given || request.spread_given)) return;
  throw InputError("missing_key", {"sweep"},
                   std::string(request.draws_given ? "a number of runs" : "a design") +
                       " is given and nothing is sampled; expected --sample KEY='uniform(FROM, TO)' or "
                       "'normal(MEAN, STD)' (what is varied runs through all combinations)");
}

}  // namespace mixloop
