// SPDX-License-Identifier: MIT
#include "processes/config_words.hpp"

#include <fmt/format.h>

#include "notation/words.hpp"

namespace mixloop {
namespace {

std::string words_of(const Path& path) {
  const auto point = [](const Eigen::Vector3d& at) {
    return fmt::format("[{:g}, {:g}, {:g}]", at.x(), at.y(), at.z());
  };
  double duration = 0;
  for (const auto& via : path.vias) duration += via.duration + via.dwell;
  if (path.vias.empty()) return "none";
  if (path.is_of_motors())
    return fmt::format("motors [{}] to [{}] in {:g} s over {} points",
                       joined("{:g}", span_of(path.vias.front().motors)),
                       joined("{:g}", span_of(path.vias.back().motors)), duration, path.vias.size());
  return fmt::format("{} to {} m in {:g} s over {} points", point(path.vias.front().point),
                     point(path.vias.back().point), duration, path.vias.size());
}

}  // namespace

ConfigWords config_words(const Experiment& experiment) {
  const Scene& scene = *experiment.scene;
  std::vector<std::string> parameters;
  for (std::size_t i = 0; i < experiment.parameters.size(); ++i)
    parameters.push_back(fmt::format("{} = {:g}", scene.parameters[i].name, experiment.parameters[i]));
  return {fmt::format("{:g} Hz", experiment.rate_hz),
          fmt::format("{} with {} motors", experiment.scene_document->place.file, scene.n_u()),
          experiment.has_path() ? words_of(experiment.path)
                                : fmt::format("none, {:g} s long", *experiment.duration),
          parameters.empty() ? "none" : joined(parameters)};
}

}  // namespace mixloop
