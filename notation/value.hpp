// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "notation/dimension.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// The node's number in SI, e.g. 0.3 for `30 cm`. Throws InputError as parse_formula does, and
/// "wrong_dimension" when it is not of dimension `wanted`.
double number_of(const Node& node, const Dimension& wanted, const std::string& what);

/// A list of `size` such numbers (a lone one counts as a list of one); any size when `size` is 0.
std::vector<double> numbers_of(const NodePtr& node, const Dimension& wanted, std::size_t size,
                               const std::string& what);

/// " (...)" for a message where twice as many values were found: as of numbers with decimal commas. Else "".
std::string decimal_commas(std::size_t found, std::size_t expected);

/// A whole number within [least, most].
long whole_number_of(const Node& node, long least, long most, const std::string& what);

/// One of the words; throws InputError("unknown_value") with the nearest. Returns its index.
std::size_t word_of(const Node& node, const std::vector<std::string>& words, const std::string& what);

}  // namespace mixloop
