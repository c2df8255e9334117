// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stability/survey.hpp"

namespace mixloop {

/// The largest spectral radius along the path over ticks and command delays: stable where it is below 1.
struct StabilityMap {
  std::string name;
  std::vector<double> ticks, delays;        ///< s
  std::vector<std::vector<double>> radius;  ///< of each tick, each delay
};

/// Ticks to 2.5 times the survey's own, delays to 1.5 of its ticks, at no more than 5 of its instants.
StabilityMap stability_map(const Survey& survey, std::string name);

/// What gnuplot is told to draw them, its terminal being set.
std::string map_commands(const std::vector<StabilityMap>& maps, const Sampling& experiment,
                         const std::string& title);

/// Draws where the radius is 1, tick across and delay upwards, with the experiment's own point, as SVG or PNG
/// after the file's ending; by gnuplot. Throws InputError for another ending, RunFault where gnuplot is
/// missing or fails.
void draw(const std::vector<StabilityMap>& maps, const Sampling& experiment, const std::string& title,
          const std::filesystem::path& file);

}  // namespace mixloop
