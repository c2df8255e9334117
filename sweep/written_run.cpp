// SPDX-License-Identifier: MIT
#include "sweep/written_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "loop/base.hpp"
#include "loop/output_file.hpp"
#include "notation/document_text.hpp"
#include "sweep/key.hpp"

namespace mixloop {
namespace {

/// The way from a folder to another one; absolute where there is none.
std::filesystem::path way(const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto absolute = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(path.empty() ? std::filesystem::path(".") : path);
  };
  return absolute(to).lexically_proximate(absolute(from));
}

}  // namespace

void write_run(const std::filesystem::path& file, const Setup& setup, std::int64_t run) {
  const auto& source = setup.request().experiment;
  NodePtr document = as_read_from(setup.document(run), way(file.parent_path(), source.parent_path()));
  const auto overrides = setup.design().overrides(run);
  std::string set;
  for (const auto& [key, value] : overrides) set += fmt::format("#   {}: {}\n", key, value);
  const std::string head =
      fmt::format("# Run {} of a sweep of {}, with\n{}", run, source.filename().string(), set);

  const bool changes_scene =
      setup.varies_scene() || std::ranges::any_of(setup.request().overrides,
                                                  [](const Override& one) { return is_of_scene(one.key); });
  if (changes_scene) {
    auto scene = file;
    scene.replace_extension(".scene.yaml");
    write_file(scene, head + document_text(*setup.scenes(run, setup.document(run)).document));
    document = override_entry(document, "scene", "'" + scene.filename().string() + "'");
  }
  auto alone = std::make_shared<Node>(*document);
  std::erase_if(alone->entries, [](const Node::Entry& entry) { return entry.key == "cases"; });
  write_file(file, head + document_text(*alone));
}

}  // namespace mixloop
