// SPDX-License-Identifier: MIT
#include "view/log_source.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

constexpr std::size_t kMostOfAPlot = 4000;  // of each plot

RunFile opened(const std::filesystem::path& path, const ReadOptions& options) {
  RunFile run = open_run(path, options);
  if (!run.scene)
    throw InputError("no_scene", {path.string()},
                     "no inputs.json beside it, so its mechanism isn't known; expected --experiment FILE");
  if (run.switches) refuse_switched({path.string()});
  return run;
}

}  // namespace

LogSource::LogSource(const std::filesystem::path& path, const ReadOptions& options)
    : run_(opened(path, options)),
      skeleton_(run_.scene, run_.parameters),
      traces_(run_.sizes.n_u, std::size_t{1} << 32) {
  std::vector<Eigen::Vector3d> way;
  read_ticks(run_, [&](const Tick& tick) {
    keep(tick);
    way.push_back(tick.desired.position);
  });
  if (way.empty()) throw InputError("no_ticks", {path.string()}, "has no tick to show");
  description_ = nlohmann::json{{"mode", "log"},
                                {"label", run_.label},
                                {"source", run_.source},
                                {"notes", run_.notes},
                                {"rate", run_.rate_hz},
                                {"first_tick", run_.first_tick},
                                {"ticks", traces_.count()},
                                {"mechanism", skeleton_.description()},
                                {"path", path_json(way)}}
                     .dump();
}

void LogSource::keep(const Tick& tick) {
  rows_.insert(rows_.end(), tick.psi.begin(), tick.psi.end());
  rows_.insert(rows_.end(), tick.tau.begin(), tick.tau.end());
  rows_.insert(rows_.end(), tick.desired.position.begin(), tick.desired.position.end());
  traces_.add(
      trace_of(tick.t, tick.actual.position, tick.desired.position, run_.scene->end_effector.axes, tick.tau));
}

std::string LogSource::newest(Cursor& cursor) {
  cursor.version = 0;
  return at_tick(run_.first_tick);
}

// A tick that the log lost shows the last one before it that there is.
std::string LogSource::at_tick(std::int64_t k) {
  const auto [n, n_u, m] = run_.sizes;
  const std::size_t width = n + n_u + 3;
  auto index =
      static_cast<std::size_t>(std::clamp<std::int64_t>(k - run_.first_tick, 0, traces_.count() - 1));
  while (index > 0 && std::isnan(rows_[index * width])) --index;
  const double* row = rows_.data() + index * width;
  Pose pose;
  pose.k = run_.first_tick + static_cast<std::int64_t>(index);
  pose.t = static_cast<double>(pose.k) / run_.rate_hz;
  pose.session = run_.session ? run_.session->session : 0;
  pose.psi.assign(row, row + n);
  pose.tau.assign(row + n, row + n + n_u);
  pose.desired = Eigen::Map<const Eigen::Vector3d>(row + n + n_u);
  return pose_json(skeleton_, pose, k == run_.first_tick ? traces_.since(0, kMostOfAPlot) : std::string());
}

}  // namespace mixloop
