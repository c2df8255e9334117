// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace mixloop {

/// Where `text` has a character that only looks like one that numbers and YAML are written with (a no-break
/// space, the minus sign U+2212, curly quotes): a clause for a message, "; ...", that says which and what is
/// meant. Else "".
std::string look_alike_in(std::string_view text);

/// "; ..." where the line begins with a tab, which is no indentation in YAML. Else "".
std::string tab_before(std::string_view line);

}  // namespace mixloop
