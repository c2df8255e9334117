// SPDX-License-Identifier: MIT
#include "loop/trajectory.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>

#include "loop/output_file.hpp"
#include "loop/truth.hpp"

namespace mixloop {
namespace {

void add_vector_names(std::string& line, const char* name, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) line += fmt::format(",{}_{}", name, i + 1);
}

/// What a line has of the end effector and of references.
struct Columns {
  bool actual = true, desired = true;
};

std::string header(std::size_t n, std::size_t n_u, const Columns& columns) {
  std::string line = "t";
  for (const char* name : {"psi", "psid"}) add_vector_names(line, name, n);
  for (const char* name : {"tau", "tau_applied"}) add_vector_names(line, name, n_u);
  const auto add_motion = [&](const char* kind) {
    for (const char* what : {"position", "velocity", "acceleration"})
      for (const char axis : {'x', 'y', 'z'}) line += fmt::format(",{}_{}_{}", what, axis, kind);
  };
  if (columns.desired) add_motion("desired");
  if (columns.actual) add_motion("actual");
  line += ",kinetic_energy,potential_energy,work";
  if (columns.desired) add_vector_names(line, "psi_desired", n_u);
  return line;
}

}  // namespace

std::string write_trajectory(const std::filesystem::path& file, const Experiment& experiment,
                             const Plan& plan, const Recorder& recorder) {
  TruthReader truth_of(experiment, recorder);
  OutputFile out(file);
  fmt::memory_buffer line;
  const auto add = [&](std::span<const double> values) {
    for (const double value : values) fmt::format_to(std::back_inserter(line), ",{}", value);
  };
  const Columns columns{.actual = experiment.scene->end_effector.named, .desired = plan.has_path()};
  out.write(header(experiment.scene->independent.size(), experiment.scene->motors().size(), columns) + "\n");
  for (std::int64_t k = 0; k < recorder.ticks_recorded(); ++k) {
    line.clear();
    fmt::format_to(std::back_inserter(line), "{}", recorder.time(k));
    for (const auto& row : {recorder.psi(k), recorder.psid(k), recorder.commanded(k), recorder.applied(k)})
      add(row);
    const Reference desired = plan.at(k);
    const Truth& truth = truth_of.at(k);
    if (columns.desired)
      for (const double* vector :
           {desired.position.data(), desired.velocity.data(), desired.acceleration.data()})
        add(std::span(vector, 3));
    if (columns.actual)
      for (const double* vector : {truth.position.data(), truth.velocity.data(), truth.acceleration.data()})
        add(std::span(vector, 3));
    add(std::array{truth.kinetic_energy, truth.potential_energy, truth.work});
    if (columns.desired) add(span_of(desired.psi));
    line.push_back('\n');
    out.write({line.data(), line.size()});
  }
  return out.publish();
}

}  // namespace mixloop
