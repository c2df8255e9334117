// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace mixloop {

/// Without the blanks (spaces, tabs, carriage returns) around it.
std::string_view trimmed(std::string_view text);

/// A word of a command line as a shell takes it: in single quotes where it needs them.
std::string shell_word(const std::string& word);

}  // namespace mixloop
