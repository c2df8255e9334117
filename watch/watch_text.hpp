// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "watch/watch.hpp"

namespace mixloop {

/// How a piece of text stands out, where the terminal can. Nothing is said by it alone.
enum class Style : std::uint8_t { plain, heading, quiet, good, warning };

struct Piece {
  std::string text;
  Style style = Style::plain;
};
using Line = std::vector<Piece>;
std::string to_text(const Line& line);

/// finished, interrupted, stopped or fault; empty before the end.
std::string ending_text(const WatchView& view);

/// A screen of this size: at most `height` lines, none longer than `width`, in ASCII. Needs 80 columns, and
/// 24 lines for three motors; where there is less room, the motors that don't fit are counted, then lines are
/// cut.
std::vector<Line> watch_lines(const WatchView& view, std::size_t width, std::size_t height);
/// The same for a reader that has no width: all of it, nothing cut.
std::vector<Line> whole_watch_lines(const WatchView& view);

/// The same in SI units, for scripts.
nlohmann::json watch_json(const WatchView& view);

}  // namespace mixloop
