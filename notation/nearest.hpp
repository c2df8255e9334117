// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mixloop {

/// The candidate that `word` most likely meant (fewest edits, a swap of neighbours being one, upper and
/// lower case alike; at most a third of its length, but one is always allowed), or "" when none is near.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

/// `; did you mean 'x'?` when one is near, else `; expected one of 'a', 'b', 'c'` (24 at most).
std::string suggestion(std::string_view word, std::span<const std::string> candidates);

}  // namespace mixloop
