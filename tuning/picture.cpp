// SPDX-License-Identifier: MIT
#include "tuning/picture.hpp"

#include <fmt/format.h>

#include "loop/simulate.hpp"
#include "stability/gnuplot.hpp"
#include "stability/map.hpp"

namespace mixloop {
namespace {

constexpr int kWidth = 800, kHeight = 330;  // of a panel, pixels

/// A curve of some hundred points that keeps its peaks: of so many ticks in a row the least and the
/// largest value.
class Curve {
 public:
  explicit Curve(std::int64_t ticks) : together_(std::max<std::int64_t>(1, ticks / 250)) {}

  void add(double x, double y) {
    if (count_ == 0 || y < least_.y) least_ = {x, y};
    if (count_ == 0 || y > most_.y) most_ = {x, y};
    if (++count_ == together_) end_bin();
  }
  std::string points(double factor) {
    if (count_ > 0) end_bin();
    std::string text;
    for (const Point& point : points_) text += fmt::format("{:.6g} {:.6g}\n", point.x, point.y * factor);
    return text;
  }

 private:
  struct Point {
    double x = 0, y = 0;
  };
  void end_bin() {
    points_.push_back(least_.x < most_.x ? least_ : most_);
    if (least_.x != most_.x) points_.push_back(least_.x < most_.x ? most_ : least_);
    count_ = 0;
  }

  std::int64_t together_, count_ = 0;
  Point least_, most_;
  std::vector<Point> points_;
};

/// A run as it is drawn, up to where it diverged.
struct Course {
  Curve error;                 ///< m over s
  std::vector<Curve> torques;  ///< of each motor
  StabilityMap map;
  Sampling sampling;
};

Course course_of(const Problem& problem, const std::vector<double>& values, const char* name) {
  const PreparedRun run = problem.setup().prepared(0, problem.overrides(values));
  const Curve empty(run.plan->ticks());
  Course course{.error = empty,
                .torques = std::vector<Curve>(run.experiment.scene->motors().size(), empty),
                .map = {},
                .sampling = {}};
  RecordedPlant plant(run.experiment, *run.plan, {.keeps_ticks = false});
  simulate(plant, [&](std::int64_t k) {
    const double time = static_cast<double>(k) / run.experiment.rate_hz;
    course.error.add(time, plant.recorder().position_error());
    const auto torque = plant.recorder().commanded(k);
    for (std::size_t i = 0; i < course.torques.size(); ++i) course.torques[i].add(time, torque[i]);
    return true;
  });
  if (!closes_loop(run.experiment)) return course;
  const Survey instants = survey(run.experiment, *run.plan, 5);
  course.sampling = instants.sampling;
  course.map = stability_map(instants, name);
  return course;
}

struct Line {
  Curve* curve;
  double factor = 1;  ///< on its values
  std::string title;
  std::string_view colour;
  bool dashed = false;
};

std::string panel(const std::string& title, const std::string& label, const std::vector<Line>& lines) {
  std::string plots, data;
  for (const Line& line : lines) {
    plots += fmt::format("{}'-' using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}",
                         plots.empty() ? "" : ", ", line.dashed ? 2 : 1, line.colour, in_gnuplot(line.title));
    data += line.curve->points(line.factor) + "e\n";
  }
  return fmt::format("set title {} noenhanced\nset xlabel 'time, s'\nset ylabel '{}'\nplot {}\n{}",
                     in_gnuplot(title), label, plots, data);
}

}  // namespace

void draw_tuned(const Problem& problem, const std::vector<double>& before, const std::vector<double>& after,
                const std::filesystem::path& file) {
  const Experiment& experiment = problem.setup().experiment();
  Course was = course_of(problem, before, "before"), is = course_of(problem, after, "tuned");
  std::vector<std::string> panels;
  if (experiment.has_path() && experiment.scene->end_effector.named)
    panels.push_back(panel("Position error of " + experiment.name, "mm",
                           {{&was.error, 1e3, "before", line_colour(0), true},
                            {&is.error, 1e3, "tuned", line_colour(0), false}}));
  std::vector<Line> torques;
  const auto motors = experiment.scene->motors();
  for (std::size_t i = 0; i < motors.size(); ++i) {
    const auto colour = line_colour(i);
    torques.push_back({&was.torques[i], 1, motors[i].name + " before", colour, true});
    torques.push_back({&is.torques[i], 1, motors[i].name + " tuned", colour, false});
  }
  if (!torques.empty()) panels.push_back(panel("Torques", "N m, or N", torques));
  if (!was.map.ticks.empty())
    panels.push_back(map_commands({is.map, was.map}, is.sampling, "Stable to the left of the lines"));
  const auto rows = static_cast<int>(panels.size());
  std::string script = fmt::format(
      "set encoding utf8\nset terminal {}\nset grid\nset key outside right noenhanced\n"
      "set multiplot layout {},1\n",
      terminal_for(file, kWidth, kHeight * rows), rows);
  for (const std::string& one : panels) script += one;
  draw_script(script + "unset multiplot\n", file);
}

}  // namespace mixloop
