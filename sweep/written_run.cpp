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

void write_experiment(const std::filesystem::path& file, const std::string& head, const Setup& setup,
                      const std::vector<Override>& values) {
  const auto& source = setup.request().experiment;
  const NodePtr as_read = setup.document(values);
  NodePtr document = as_read_from(as_read, way(file.parent_path(), source.parent_path()));
  const bool changes_scene =
      setup.varies_scene() || std::ranges::any_of(setup.request().overrides,
                                                  [](const Override& one) { return is_of_scene(one.key); });
  if (changes_scene) {
    auto scene = file;
    scene.replace_extension(".scene.yaml");
    write_file(scene, head + document_text(*setup.scenes(values, as_read).document));
    document = override_entry(document, "scene", "'" + scene.filename().string() + "'");
  }
  auto alone = std::make_shared<Node>(*document);
  std::erase_if(alone->entries, [](const Node::Entry& entry) { return entry.key == "cases"; });
  write_file(file, head + document_text(*alone));
}

void write_run(const std::filesystem::path& file, const Setup& setup, std::int64_t run) {
  const auto values = setup.design().overrides(run);
  std::string head =
      fmt::format("# Run {} of a sweep of {}, with\n", run, setup.request().experiment.filename().string());
  for (const auto& [key, value] : values) head += fmt::format("#   {}: {}\n", key, value);
  write_experiment(file, head, setup, values);
}

}  // namespace mixloop
