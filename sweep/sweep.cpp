// SPDX-License-Identifier: MIT
#include "sweep/sweep.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "loop/inputs.hpp"
#include "loop/origin.hpp"
#include "notation/sha256.hpp"
#include "sweep/command_text.hpp"

namespace mixloop {
namespace {

/// Of what the experiment's files say, overrides applied; what the controller reads from a file included.
std::string hash_of(const Experiment& experiment) {
  std::string text = line_of(*experiment.document) + line_of(*experiment.scene_document) +
                     experiment.controller_scene->canonical;
  const NodePtr controller = find_entry(*experiment.document, "controller");
  if (const NodePtr file = find_entry(*controller, "file")) {
    std::ifstream samples(experiment.file.parent_path() / file->text, std::ios::binary);
    text.append(std::istreambuf_iterator<char>(samples), {});
  }
  return sha256_hex(text);
}

}  // namespace

Sweep::Sweep(std::string name, const SweepRequest& request, Evaluation evaluation, bool hashes)
    : name_(std::move(name)),
      setup_(request, evaluation),
      telling_{.columns = Columns(setup_.experiment(), request.settled_within.has_value()),
               .settled_within = request.settled_within,
               .hashes = hashes} {
  const Experiment& experiment = setup_.experiment();
  std::optional<double> limit;
  if (experiment.has_path()) limit = experiment.position_error_limit;
  for (const ShareBound& bound : request.expect)
    bounds_.push_back({bound.share, read_expectation(bound.expected, *experiment.scene, limit), bound.place});

  settings_ = {{"mixloop", origin_here().mixloop},
               {"experiment", request.experiment.string()},
               {"experiment_sha256", hash_of(experiment)}};
  for (const Variation& one : setup_.design().variations())
    settings_.emplace_back(one.distribution ? "sample " + one.key : "vary " + one.key, one.written());
  settings_.emplace_back("runs", fmt::format("{}", runs()));
  if (!request.design.sampled.empty()) {
    settings_.emplace_back("design", name_of(request.design.spread));
    settings_.emplace_back("seed", fmt::format("{}", request.design.seed));
  }
  settings_.emplace_back("settled_within",
                         request.settled_within ? fmt::format("{} m", *request.settled_within) : "none");
  settings_.emplace_back("hashes", hashes ? "yes" : "no");
  // The interpreter and machine code have the same bits, the procedure itself has others.
  settings_.emplace_back("equations", evaluation == Evaluation::reference ? "reference" : "program");
  std::string all;
  for (const auto& [key, value] : settings_)
    if (key != "experiment") all += key + ": " + value + "\n";
  sha256_ = sha256_hex(all);
  require_some_run();
}

void Sweep::require_some_run() const {
  static constexpr std::int64_t kLooked = 4;
  std::optional<InputError> first;
  for (std::int64_t i = 0; i <= kLooked; ++i) try {
      setup_.prepared((runs() - 1) * i / kLooked);
      return;
    } catch (const InputError& error) {
      if (!first) first = error;
    }
  throw InputError(first->code, first->place,
                   first->message + "; so it is in all of " + std::to_string(kLooked + 1) +
                       " runs looked at, first: " + command(0));
}

std::string Sweep::command(std::int64_t run) const {
  return simulate_command(setup_.request().experiment, setup_.request().overrides,
                          setup_.design().overrides(run));
}

}  // namespace mixloop
