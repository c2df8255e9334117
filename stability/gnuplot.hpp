// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mixloop {

/// A text as a gnuplot script has it, in single quotes.
std::string in_gnuplot(const std::string& text);

/// The i-th line's, of Okabe & Ito's palette, told apart by most colour-blind readers.
std::string_view line_colour(std::size_t i);

/// What a script's `set terminal` says for this file, .svg or .png; in pixels. Throws InputError for another
/// ending.
std::string terminal_for(const std::filesystem::path& file, int width, int height);

/// Draws a script, whose terminal is that of the file. Throws RunFault("no_picture") where gnuplot is missing
/// or fails, and "cannot_write".
void draw_script(const std::string& script, const std::filesystem::path& file);

}  // namespace mixloop
