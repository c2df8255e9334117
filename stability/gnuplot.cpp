// SPDX-License-Identifier: MIT
#include "stability/gnuplot.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cstdio>
#include <optional>

#include "loop/output_file.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

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

std::string in_gnuplot(const std::string& text) {
  std::string result = "'";
  for (const char c : text)
    if (c == '\'')
      result += "''";
    else if (c != '\n')
      result += c;
  return result + "'";
}

std::string_view line_colour(std::size_t i) {
  static constexpr std::string_view kColours[] = {"#0072B2", "#D55E00", "#009E73",
                                                  "#CC79A7", "#E69F00", "#56B4E9"};
  return kColours[i % std::size(kColours)];
}

std::string terminal_for(const std::filesystem::path& file, int width, int height) {
  if (file.extension() == ".svg")
    return fmt::format("svg size {},{} dynamic font 'Helvetica,14' background rgb 'white'", width, height);
  if (file.extension() == ".png") return fmt::format("pngcairo size {},{} font 'Sans,11'", width, height);
  throw InputError("unknown_value", {file.string()}, "a picture's name ends in .svg or .png");
}

void draw_script(const std::string& script, const std::filesystem::path& file) {
  const std::optional<std::string> picture = drawn(script);
  if (!picture || picture->empty())
    throw RunFault("no_picture", "gnuplot could not draw " + file.string() + "; is gnuplot-nox installed?");
  write_file(file, *picture);
}

}  // namespace mixloop
