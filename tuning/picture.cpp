// SPDX-License-Identifier: MIT
#include "tuning/picture.hpp"

#include <fmt/format.h>

#include "loop/simulate.hpp"
#include "stability/gnuplot.hpp"
#include "stability/map.hpp"

namespace mixloop {
namespace {

constexpr int kWidth = 800, kHeight = 330;  // of a panel, pixels

/// A run as it is drawn, tick by tick, up to where it diverged.
struct Course {
  std::vector<double> times, errors;         ///< s, m
  std::vector<std::vector<double>> torques;  ///< of each motor
  StabilityMap map;
  Sampling sampling;
};

Course course_of(const Problem& problem, const std::vector<double>& values, const char* name) {
  const PreparedRun run = problem.setup().prepared(0, problem.overrides(values));
  Course course{.times = {}, .errors = {}, .torques = {}, .map = {}, .sampling = {}};
  course.torques.resize(run.experiment.scene->motors().size());
  RecordedPlant plant(run.experiment, *run.plan, {.keeps_ticks = false});
  simulate(plant, [&](std::int64_t k) {
    course.times.push_back(static_cast<double>(k) / run.experiment.rate_hz);
    course.errors.push_back(plant.recorder().position_error());
    const auto torque = plant.recorder().commanded(k);
    for (std::size_t i = 0; i < course.torques.size(); ++i) course.torques[i].push_back(torque[i]);
    return true;
  });
  if (!closes_loop(run.experiment)) return course;
  const Survey instants = survey(run.experiment, *run.plan, 5);
  course.sampling = instants.sampling;
  course.map = stability_map(instants, name);
  return course;
}

struct Line {
  const std::vector<double>*x, *y;
  double factor = 1;  ///< on y
  std::string title;
  std::string_view colour;
  bool dashed = false;
};

std::string panel(const std::string& title, const std::string& label, const std::vector<Line>& lines) {
  std::string plots, data;
  for (const Line& line : lines) {
    plots += fmt::format("{}'-' using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}",
                         plots.empty() ? "" : ", ", line.dashed ? 2 : 1, line.colour, in_gnuplot(line.title));
    for (std::size_t i = 0; i < line.x->size(); ++i)
      data += fmt::format("{:.9g} {:.9g}\n", (*line.x)[i], (*line.y)[i] * line.factor);
    data += "e\n";
  }
  return fmt::format("set title {} noenhanced\nset xlabel 'time, s'\nset ylabel '{}'\nplot {}\n{}",
                     in_gnuplot(title), label, plots, data);
}

}  // namespace

void draw_tuned(const Problem& problem, const std::vector<double>& before, const std::vector<double>& after,
                const std::filesystem::path& file) {
  const Experiment& experiment = problem.setup().experiment();
  const Course was = course_of(problem, before, "before"), is = course_of(problem, after, "tuned");
  std::vector<std::string> panels;
  if (experiment.has_path() && experiment.scene->end_effector.named)
    panels.push_back(panel("Position error of " + experiment.name, "mm",
                           {{&was.times, &was.errors, 1e3, "before", line_colour(0), true},
                            {&is.times, &is.errors, 1e3, "tuned", line_colour(0), false}}));
  std::vector<Line> torques;
  const auto motors = experiment.scene->motors();
  for (std::size_t i = 0; i < motors.size(); ++i) {
    const auto colour = line_colour(i);
    torques.push_back({&was.times, &was.torques[i], 1, motors[i].name + " before", colour, true});
    torques.push_back({&is.times, &is.torques[i], 1, motors[i].name + " tuned", colour, false});
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
