// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace mixloop {

/// Where in a file something stands; line and column count from 1, line 0 means the file as a whole.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// `file:line:column`, without the parts that are not known; printable.
std::string to_string(const Place& place);

/// Bad input: what was found, what was expected, and where; printable. Ends a command with exit status 2.
struct InputError : std::runtime_error {
  InputError(std::string code, const Place& place, const std::string& message);

  std::string code;     ///< a word for scripts, e.g. "unknown_key"
  Place place;          ///< where
  std::string message;  ///< without the place; what() has both
};

/// A fault at run time (a lost peer, divergence, a singularity). Ends a command with exit status 3.
struct RunFault : std::runtime_error {
  RunFault(std::string code_, const std::string& message);

  std::string code;
};

}  // namespace mixloop
