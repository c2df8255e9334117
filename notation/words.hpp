// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mixloop {

/// Without the blanks (spaces, tabs, carriage returns) around it.
std::string_view trimmed(std::string_view text);

/// The words of a list, `between` each two.
std::string joined(std::span<const std::string> words, std::string_view between = ", ");

/// As a sentence lists them: a, b and c.
std::string enumerated(std::span<const std::string> words);

/// The numbers of a list.
std::string joined(std::span<const int> numbers, std::string_view between);
/// The same, each as fmt writes a double by `format`.
std::string joined(std::string_view format, std::span<const double> numbers, std::string_view between = ", ");

/// A word of a command line as a shell takes it: in single quotes where it needs them.
std::string shell_word(const std::string& word);

}  // namespace mixloop
