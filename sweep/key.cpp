// SPDX-License-Identifier: MIT
#include "sweep/key.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/scene/scene_keys.hpp"
#include "loop/experiment_keys.hpp"
#include "notation/document_path.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::string_view kScene = "scene.";

/// Goes down a document along a path, and down the forms of what may stand there.
class KeyWalk {
 public:
  /// `parameters`: the names that stand for entries of an experiment's `parameters`.
  KeyWalk(const Variation& variation, std::vector<std::string> parameters)
      : variation_(variation), parameters_(std::move(parameters)) {}

  void go(const Form& form, const NodePtr& node, std::span<const PathStep> steps) {
    if (steps.empty() || form.kind == Form::Kind::any) return;
    const PathStep& step = steps.front();
    switch (form.kind) {
      case Form::Kind::one_of:
        return into_one(form, node, steps);
      case Form::Kind::list:
        return into_list(form, node, steps);
      case Form::Kind::named:
      case Form::Kind::mapping:
        break;
      default:
        fail("invalid_path", fmt::format("{} is a single value; expected a key that ends with it", before_));
    }
    if (step.is_index) fail("invalid_path", fmt::format("{} is no list; expected a name behind it", before_));
    const NodePtr inner = node && node->kind == Node::Kind::mapping ? find_entry(*node, step.key) : nullptr;
    const Form& of = form.kind == Form::Kind::named ? named(form, node, step.key) : keyed(form, step.key);
    before_ = in_quotes(step.key);
    go(of, inner, steps.subspan(1));
  }

 private:
  [[noreturn]] void fail(const std::string& code, const std::string& message) const {
    throw InputError(code, variation_.place, message);
  }

  const Form& keyed(const Form& form, const std::string& key) const {
    const Keys& keys = form.keys();
    const auto known = std::ranges::find(keys.all, key, &Key::name);
    if (known != keys.all.end()) return known->form;
    std::vector<std::string> names;
    for (const Key& one : keys.all) names.push_back(one.name);
    fail("unknown_key", fmt::format("{} has no key {}{}", keys.what, in_quotes(key), suggestion(key, names)));
  }

  const Form& named(const Form& form, const NodePtr& node, const std::string& name) const {
    std::vector<std::string> names;
    if (node && node->kind == Node::Kind::mapping)
      for (const auto& entry : node->entries) names.push_back(entry.key);
    if (before_.ends_with("parameters'")) names.insert(names.end(), parameters_.begin(), parameters_.end());
    if (std::ranges::find(names, name) == names.end())
      fail("unknown_key",
           fmt::format("{} has no entry {}{}", before_, in_quotes(name), suggestion(name, names)));
    return form.of.front();
  }

  void into_list(const Form& form, const NodePtr& node, std::span<const PathStep> steps) {
    const PathStep& step = steps.front();
    if (!step.is_index && form.of.front().kind == Form::Kind::mapping && node &&
        node->kind == Node::Kind::mapping)
      return go(form.of.front(), node, steps);
    if (!step.is_index)
      fail("invalid_path",
           fmt::format("{} is a list; expected which item, e.g. [0] of the first one", before_));
    const std::size_t size = node && node->kind == Node::Kind::sequence ? node->items.size() : 0;
    if (step.index >= size)
      fail("invalid_path", fmt::format("{} has no item [{}]: it is {}", before_, step.index,
                                       node ? describe(*node) : "not there"));
    go(form.of.front(), node->items[step.index], steps.subspan(1));
  }

  /// The alternatives one after the other; what the last one has against it counts.
  void into_one(const Form& form, const NodePtr& node, std::span<const PathStep> steps) {
    const std::string before = before_;
    for (std::size_t i = 0; i + 1 < form.of.size(); ++i) try {
        before_ = before;
        return go(form.of[i], node, steps);
      } catch (const InputError&) {
      }
    before_ = before;
    go(form.of.back(), node, steps);
  }

  const Variation& variation_;
  std::vector<std::string> parameters_;
  std::string before_ = "the file";
};

}  // namespace

bool is_of_scene(const std::string& key) { return key.starts_with(kScene); }

void require_key(const Variation& variation, const NodePtr& experiment, const ExperimentScenes& scenes) {
  const bool of_scene = is_of_scene(variation.key);
  const std::string_view key = std::string_view(variation.key).substr(of_scene ? kScene.size() : 0);
  const auto steps = path_steps(key, variation.place);
  static constexpr std::array kOutside = {"base", "cases", "expect"};
  if (!of_scene && std::ranges::find(kOutside, steps.front().key) != kOutside.end())
    throw InputError("invalid_path", variation.place,
                     in_quotes(steps.front().key) + " changes no run; expected an entry that does");
  std::vector<std::string> parameters;
  for (const Scene* scene : {scenes.scene.get(), scenes.controller_scene.get()})
    for (const auto& parameter : scene->parameters) parameters.push_back(parameter.name);
  KeyWalk(variation, of_scene ? std::vector<std::string>() : parameters)
      .go(form::mapping(of_scene ? scene_keys : experiment_keys), of_scene ? scenes.document : experiment,
          steps);
}

}  // namespace mixloop
