// SPDX-License-Identifier: MIT
#include "commands/records/web_page.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "notation/errors.hpp"
#include "processes/called_as.hpp"

namespace mixloop {

std::string web_page(const std::string& name) {
  const std::string file = shared_file(name);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in || text.str().empty())
    throw RunFault("missing_part",
                   fmt::format("the page {} is missing ({}); it is built where there is Node.js 18 "
                               "or later with npm: apt-get install nodejs npm, then build again",
                               name, file));
  return text.str();
}

}  // namespace mixloop
