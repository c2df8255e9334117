// SPDX-License-Identifier: MIT
#include "sweep/kept_sweep.hpp"

#include <charconv>
#include <nlohmann/json.hpp>

#include "loop/output_file.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"
#include "sweep/command_text.hpp"

namespace mixloop {
namespace {

using nlohmann::ordered_json;

constexpr const char* kFile = "asked.yaml";

/// A list as it was written, texts apart so that none is taken for a range.
ordered_json listed_json(const Variation& variation) {
  return variation.is_number() ? ordered_json(variation.written()) : ordered_json(variation.texts);
}

std::vector<std::pair<std::string, std::string>> pairs_in(const NodePtr& list, const char* what) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const NodePtr& item : items_of(list, what)) {
    const auto both = items_of(item, what);
    if (both.size() != 2)
      throw InputError("wrong_size", item->place, std::string("expected two texts: ") + what);
    pairs.emplace_back(text_of(*both[0], what), text_of(*both[1], what));
  }
  return pairs;
}

/// Of 64 bits, which a number of YAML's need not hold.
std::uint64_t seed_of(const Node& node) {
  const std::string& text = text_of(node, "the seed");
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError("wrong_kind", node.place,
                     "the seed is " + in_quotes(text) + "; expected a whole number");
  return seed;
}

}  // namespace

std::string KeptSweep::command(std::int64_t run) const {
  return simulate_command(experiment, overrides, design.overrides(run));
}

bool is_sweep_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  const auto has = [&](const char* name) { return std::filesystem::exists(folder / name, failed); };
  return has("sweep.yaml") || has(kFile) || has("journal") || (has("table.csv") && has("summary.json"));
}

KeptSweep read_kept_sweep(const std::filesystem::path& folder) {
  const auto file = folder / kFile;
  std::error_code failed;
  if (!std::filesystem::exists(file, failed))
    throw InputError("no_such_file", {file.string()},
                     "the sweep was kept without it, by an earlier version or in part; expected what mixloop "
                     "sweep --out keeps: the same command in the same folder writes it, and runs nothing "
                     "that is there");
  const Mapping root(read_document(file), "what a folder keeps of its sweep",
                     {"sweep", "called", "experiment", "set", "vary", "sample", "draws", "design", "seed",
                      "columns", "sha256"});
  const auto text = [&](const char* key) { return text_of(*root.at(key), key); };
  Design::Settings settings;
  for (const auto& entry : root.at("vary")->entries) settings.varied.push_back(read_varied(entry));
  for (const auto& entry : root.at("sample")->entries) settings.sampled.push_back(read_sampled(entry));
  settings.draws = whole_number_of(*root.at("draws"), 1, 1L << 40, "the number of runs");
  settings.seed = seed_of(*root.at("seed"));
  const std::string design = text("design");
  const std::uint64_t seed = settings.seed;
  if (const auto spread = spread_named(
          spread_names()[word_of(*root.at("design"), spread_names(), "how what is drawn is spread")]))
    settings.spread = *spread;
  const bool draws = !settings.sampled.empty();
  KeptSweep kept{.name = text("sweep"),
                 .called = text("called"),
                 .experiment = text("experiment"),
                 .overrides = {},
                 .design = Design(std::move(settings)),
                 .spread = draws ? design : "",
                 .seed = seed,
                 .columns = {},
                 .sha256 = text("sha256")};
  for (auto& [key, value] : pairs_in(root.at("set"), "a key and what it is set to"))
    kept.overrides.push_back({key, value});
  for (auto& [name, unit] : pairs_in(root.at("columns"), "a column's name and its unit"))
    kept.columns.push_back({name, unit});
  return kept;
}

void write_kept_sweep(const std::filesystem::path& folder, const Sweep& sweep) {
  const SweepRequest& request = sweep.setup().request();
  ordered_json json = {{"sweep", sweep.name()},
                       {"called", request.called},
                       {"experiment", request.experiment.string()},
                       {"set", ordered_json::array()},
                       {"vary", ordered_json::object()},
                       {"sample", ordered_json::object()},
                       {"draws", request.design.draws},
                       {"design", name_of(request.design.spread)},
                       {"seed", request.design.seed},
                       {"columns", ordered_json::array()},
                       {"sha256", sweep.sha256()}};
  for (const Override& one : request.overrides) json["set"].push_back({one.key, one.value});
  for (const Variation& one : request.design.varied) json["vary"][one.key] = listed_json(one);
  for (const Variation& one : request.design.sampled) json["sample"][one.key] = one.written();
  for (const auto& column : sweep.telling().columns.all())
    json["columns"].push_back({column.name, column.unit});
  write_file(folder / kFile, "# What this folder's runs are of, in full; written by mixloop sweep.\n" +
                                 json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace mixloop
