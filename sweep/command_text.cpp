// SPDX-License-Identifier: MIT
#include "sweep/command_text.hpp"

namespace mixloop {

std::string shell_quoted(const std::string& text) {
  if (!text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                              "._-+=/,:@%") == std::string::npos)
    return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string simulate_command(const std::filesystem::path& experiment, const std::vector<Override>& all,
                             const std::vector<Override>& of_the_run) {
  std::string text = "mixloop simulate " + shell_quoted(experiment.string());
  for (const auto* overrides : {&all, &of_the_run})
    for (const Override& one : *overrides) text += " --set " + shell_quoted(one.key + "=" + one.value);
  return text;
}

}  // namespace mixloop
