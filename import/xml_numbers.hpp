// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "import/xml_file.hpp"

namespace mixloop {

/// The number of an attribute, `unless` where the element or the attribute is absent. Throws InputError
/// ("wrong_kind") for what is no finite number.
double number_in(const XmlFile& file, const XmlFile::Element* element, const char* attribute, double unless);
/// Three numbers, parted by blanks ("wrong_size" for more or fewer).
std::array<double, 3> triple_in(const XmlFile& file, const XmlFile::Element* element, const char* attribute,
                                std::array<double, 3> unless);

/// Holds that all attributes of a URDF's links and joints that are numbers are numbers, as many as they
/// should be, and those that it can't do without are there ("missing_key").
void check_numbers(const XmlFile& file);

}  // namespace mixloop
