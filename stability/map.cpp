// SPDX-License-Identifier: MIT
#include "stability/map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/long_work.hpp"
#include "stability/gnuplot.hpp"

namespace mixloop {
namespace {

constexpr int kTicks = 50, kDelays = 30;
constexpr std::size_t kMostPoses = 5;

Survey thinned(const Survey& whole) {
  const std::size_t stride = (whole.loops.size() + kMostPoses - 1) / kMostPoses;
  Survey survey{.sampling = whole.sampling, .times = {}, .loops = {}};
  for (std::size_t i = 0; i < whole.loops.size(); i += stride) {
    survey.times.push_back(whole.times[i]);
    survey.loops.push_back(whole.loops[i]);
  }
  return survey;
}

/// A grid for gnuplot. Radii beyond 2 would only bend the contour between its neighbours.
std::string grid(const StabilityMap& map) {
  std::string text;
  for (std::size_t i = 0; i < map.ticks.size(); ++i, text += "\n")
    for (std::size_t j = 0; j < map.delays.size(); ++j)
      text += fmt::format("{:.9g} {:.9g} {:.9g}\n", map.ticks[i] * 1e3, map.delays[j] * 1e3,
                          std::min(map.radius[i][j], 2.0));
  return text + "e\n";
}

}  // namespace

StabilityMap stability_map(const Survey& survey, std::string name) {
  const Survey instants = thinned(survey);
  const double tick = survey.sampling.tick;
  StabilityMap map{.name = std::move(name), .ticks = {}, .delays = {}, .radius = {}};
  for (int j = 0; j <= kDelays; ++j) map.delays.push_back(1.5 * tick * j / kDelays);
  for (int i = 1; i <= kTicks; ++i) {
    map.ticks.push_back(2.5 * tick * i / kTicks);
    auto& row = map.radius.emplace_back();
    for (const double delay : map.delays) {
      work_goes_on();
      row.push_back(path_radius(instants, {map.ticks.back(), delay}));
    }
  }
  return map;
}

std::string map_commands(const std::vector<StabilityMap>& maps, const Sampling& experiment,
                         const std::string& title) {
  std::string text = fmt::format(
      "set title {} noenhanced\nset grid\n"
      "set key top right noenhanced\nset xlabel 'tick, ms'\nset ylabel 'command delay, ms'\n"
      "set view map\nset contour base\nset cntrparam levels discrete 1\nset cntrlabel onecolor\nunset "
      "surface\n"
      "set label 'the experiment' at {:.9g},{:.9g} point pt 7 ps 1.2 lc rgb 'black' offset 0.7,0.7 front\n",
      in_gnuplot(title), experiment.tick * 1e3, experiment.delay * 1e3);
  std::string plots, data;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    plots += fmt::format("{}'-' using 1:2:3 with lines lw 2 dt {} lc rgb '{}' title {}", i ? ", " : "",
                         i % 4 + 1, line_colour(i), in_gnuplot(maps[i].name));
    data += grid(maps[i]);
  }
  return text + "splot " + plots + "\n" + data;
}

void draw(const std::vector<StabilityMap>& maps, const Sampling& experiment, const std::string& title,
          const std::filesystem::path& file) {
  draw_script(fmt::format("set encoding utf8\nset terminal {}\n", terminal_for(file, 800, 560)) +
                  map_commands(maps, experiment, title + ": stable to the left of the lines"),
              file);
}

}  // namespace mixloop
