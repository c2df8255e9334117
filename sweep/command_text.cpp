// SPDX-License-Identifier: MIT
#include "sweep/command_text.hpp"

#include "notation/words.hpp"

namespace mixloop {

std::string simulate_command(const std::filesystem::path& experiment, const std::vector<Override>& all,
                             const std::vector<Override>& of_the_run) {
  std::string text = "mixloop simulate " + shell_word(experiment.string());
  for (const auto* overrides : {&all, &of_the_run})
    for (const Override& one : *overrides) text += " --set " + shell_word(one.key + "=" + one.value);
  return text;
}

}  // namespace mixloop
