// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

#include <mixloop/api.hpp>

namespace mixloop::v1 {

/// The one exception of the library: bad input, a fault at run time, or a call that doesn't fit. what() is
/// `FILE:LINE:COLUMN: message`; the codes stand in docs/errors.md.
class MIXLOOP_API Error : public std::runtime_error {
 public:
  /// Where in a file something stands; line and column count from 1, 0 where they are not known.
  struct Place {
    std::string file;  ///< or what stands for one, e.g. `--set rate`; empty where there is none
    int line = 0;      ///< from 1
    int column = 0;    ///< from 1, in bytes
  };

  /// What the library throws it with.
  Error(std::string code, Place place, std::string message);
  ~Error() override;

  const std::string& code() const noexcept { return code_; }  ///< a word for programs, e.g. "unknown_key"
  const Place& place() const noexcept { return place_; }      ///< where the mistake is
  const std::string& message() const noexcept { return message_; }  ///< without the place

 private:
  std::string code_;
  Place place_;
  std::string message_;
};

}  // namespace mixloop::v1
