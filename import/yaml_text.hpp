// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mixloop {

/// A text as a YAML scalar, quoted where it must be.
std::string yaml_text(std::string_view text);

/// A number with the digits that read back as the same double, and its unit: "0.1 kg"; zero is "0".
std::string quantity(double value, std::string_view unit);
/// An angle, in degrees where a multiple of half a degree reads back as the same double, else in rad.
std::string angle_text(double radians);
/// "[0, 0, 0.1 m]"
std::string list_text(std::span<const double> values, std::string_view unit);
std::string angles_text(std::span<const double> radians);

/// YAML whose lines of more than 116 characters are broken behind commas of their lists and mappings.
std::string broken_lines(std::string_view yaml);

/// The text as comment lines of at most 116 characters, broken between words.
std::string comment(std::string_view text);

}  // namespace mixloop
