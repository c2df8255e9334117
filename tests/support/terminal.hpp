// SPDX-License-Identifier: MIT
#pragma once

#include <termios.h>

#include <chrono>
#include <string>
#include <vector>

namespace mixloop {

/// A command on a terminal of its own: its screen as text, by the control sequences that ncurses sends to a
/// vt100 and to an xterm.
class Terminal {
 public:
  Terminal(const std::vector<std::string>& words, const std::vector<std::string>& environment, int rows,
           int columns);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys);
  void resize(int rows, int columns);

  /// Reads until the screen has the text; false after the limit.
  bool shows(const std::string& text, std::chrono::milliseconds limit = std::chrono::seconds(20));
  /// Reads to the command's end; its exit status, or 128 + its signal, or -1 (then it is killed) after the
  /// limit.
  int wait(std::chrono::milliseconds limit = std::chrono::seconds(20));

  std::string screen() const;                       ///< its rows, without blanks at their ends
  const std::string& sent() const { return all_; }  ///< every byte
  termios settings() const;

 private:
  bool read_more(std::chrono::milliseconds limit);
  void take(char c);
  void put(char c);
  void control(char c);
  void sequence(const std::string& parameters, char final);
  void scroll(int lines);
  void erase(std::size_t from, std::size_t to);
  std::size_t at() const { return static_cast<std::size_t>(row_ * columns_ + column_); }

  int pid_ = -1, master_ = -1, slave_ = -1, status_ = -2;
  int rows_, columns_, row_ = 0, column_ = 0, top_ = 0, bottom_;
  std::string cells_, all_, pending_;
  char last_ = ' ';
};

}  // namespace mixloop
