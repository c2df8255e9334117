// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "watch/watch_text.hpp"

namespace mixloop {

/// A terminal's whole screen, by ncurses. It is left as it was found, whatever ends the program in order;
/// Ctrl-Z and changes of size are ncurses' affair.
class Screen {
 public:
  /// Throws InputError `no_terminal` where stdout and stdin are none or TERM is not known. Colours only where
  /// the terminal has them and they are asked for.
  explicit Screen(bool colours);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  std::size_t width() const;
  std::size_t height() const;
  /// The lines from the top, and `last` at the bottom.
  void show(const std::vector<Line>& lines, const std::string& last);

  enum class Key { none, quit, forget, resized };
  /// A key that was pressed since the last call.
  Key key();

 private:
  struct Terminal;
  Terminal* terminal_;
  bool colours_;
};

}  // namespace mixloop
