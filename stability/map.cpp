// SPDX-License-Identifier: MIT
#include "stability/map.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "loop/output_file.hpp"
#include "notation/errors.hpp"
#include "notation/long_work.hpp"

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

/// A text between gnuplot's single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text)
    if (c == '\'')
      result += "''";
    else if (c != '\n')
      result += c;
  return result + "'";
}

std::string terminal_for(const std::filesystem::path& file) {
  if (file.extension() == ".svg")
    return "svg size 800,560 dynamic font 'Helvetica,14' background rgb 'white'";
  if (file.extension() == ".png") return "pngcairo size 800,560 font 'Sans,11'";
  throw InputError("unknown_value", {file.string()}, "a picture's name ends in .svg or .png");
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

std::string script(const std::vector<StabilityMap>& maps, const Sampling& experiment,
                   const std::string& title, const std::filesystem::path& file) {
  // Okabe & Ito's palette, told apart by most colour-blind readers.
  static constexpr std::string_view kColours[] = {"#0072B2", "#D55E00", "#009E73",
                                                  "#CC79A7", "#E69F00", "#56B4E9"};
  std::string text = fmt::format(
      "set encoding utf8\nset terminal {}\nset title {} noenhanced\nset grid\n"
      "set key top right noenhanced\nset xlabel 'tick, ms'\nset ylabel 'command delay, ms'\n"
      "set view map\nset contour base\nset cntrparam levels discrete 1\nset cntrlabel onecolor\nunset "
      "surface\n"
      "set label 'the experiment' at {:.9g},{:.9g} point pt 7 ps 1.2 lc rgb 'black' offset 0.7,0.7 front\n",
      terminal_for(file), quoted(title + ": stable to the left of the lines"), experiment.tick * 1e3,
      experiment.delay * 1e3);
  std::string plots, data;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    plots += fmt::format("{}'-' using 1:2:3 with lines lw 2 dt {} lc rgb '{}' title {}", i ? ", " : "",
                         i % 4 + 1, kColours[i % std::size(kColours)], quoted(maps[i].name));
    data += grid(maps[i]);
  }
  return text + "splot " + plots + "\n" + data;
}

/// What gnuplot makes of a script: it says on its stdout what is a picture, and nothing where it could not
/// draw. It does not say whether it could write a file.
std::optional<std::string> drawn(const std::string& text) {
  const int fd = memfd_create("mixloop-script", 0);
  FILE* in = fd >= 0 ? fdopen(fd, "w") : nullptr;
  if (!in) return std::nullopt;
  const bool written = std::fwrite(text.data(), 1, text.size(), in) == text.size() && std::fflush(in) == 0;
  FILE* gnuplot = written ? popen(fmt::format("gnuplot /proc/self/fd/{}", fd).c_str(), "r") : nullptr;
  std::string picture;
  char buffer[4096];
  for (std::size_t size = 0; gnuplot && (size = std::fread(buffer, 1, sizeof buffer, gnuplot)) > 0;)
    picture.append(buffer, size);
  const int status = gnuplot ? pclose(gnuplot) : -1;
  std::fclose(in);
  if (status != 0) return std::nullopt;
  return picture;
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

void draw(const std::vector<StabilityMap>& maps, const Sampling& experiment, const std::string& title,
          const std::filesystem::path& file) {
  const std::optional<std::string> picture = drawn(script(maps, experiment, title, file));
  if (!picture || picture->empty())
    throw RunFault("no_picture", "gnuplot could not draw " + file.string() + "; is gnuplot-nox installed?");
  write_file(file, *picture);
}

}  // namespace mixloop
