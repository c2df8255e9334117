// SPDX-License-Identifier: MIT
#include "commands/runs/screen.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "notation/errors.hpp"

#define NCURSES_NOMACROS
#include <curses.h>

namespace mixloop {
namespace {

constexpr short kGood = 1, kWarning = 2;

attr_t attributes(Style style, bool colours) {
  switch (style) {
    case Style::heading:
      return A_BOLD;
    case Style::quiet:
      return A_DIM;
    case Style::good:
      return colours ? COLOR_PAIR(kGood) : A_NORMAL;
    case Style::warning:
      return colours ? COLOR_PAIR(kWarning) : A_BOLD | A_REVERSE;
    case Style::plain:
      break;
  }
  return A_NORMAL;
}

}  // namespace

struct Screen::Terminal {
  SCREEN* screen;
};

Screen::Screen(bool colours) : terminal_(nullptr), colours_(false) {
  const char* name = std::getenv("TERM");
  if (!isatty(STDOUT_FILENO) || !isatty(STDIN_FILENO))
    throw InputError("no_terminal", {},
                     "a screen needs a terminal, and this is none; --once prints it, --json for scripts");
  SCREEN* screen = newterm(nullptr, stdout, stdin);
  if (!screen)
    throw InputError("no_terminal", {},
                     std::string("the terminal TERM=") + (name ? name : "") +
                         " is not known here; expected one as xterm, screen or vt100 (--once needs none)");
  terminal_ = new Terminal{screen};
  cbreak();
  noecho();
  nodelay(stdscr, true);
  keypad(stdscr, true);
  curs_set(0);
  colours_ = colours && has_colors();
  if (!colours_) return;
  // Blue and yellow: told apart by eyes that don't tell red from green. As a ground under black, for as
  // letters neither stands out on a white terminal.
  start_color();
  use_default_colors();
  init_pair(kGood, COLOR_BLACK, COLOR_CYAN);
  init_pair(kWarning, COLOR_BLACK, COLOR_YELLOW);
}

Screen::~Screen() {
  endwin();
  delscreen(terminal_->screen);
  delete terminal_;
}

std::size_t Screen::width() const { return static_cast<std::size_t>(getmaxx(stdscr)); }
std::size_t Screen::height() const { return static_cast<std::size_t>(getmaxy(stdscr)); }

void Screen::show(const std::vector<Line>& lines, const std::string& last) {
  werase(stdscr);
  const int bottom = getmaxy(stdscr) - 1;
  for (int row = 0; row < std::min(bottom, static_cast<int>(lines.size())); ++row) {
    wmove(stdscr, row, 0);
    for (const Piece& piece : lines[static_cast<std::size_t>(row)]) {
      wattrset(stdscr, static_cast<int>(attributes(piece.style, colours_)));
      waddnstr(stdscr, piece.text.c_str(), getmaxx(stdscr) - getcurx(stdscr));
    }
  }
  wattrset(stdscr, static_cast<int>(A_DIM));
  // The last column of the last row stays free: some terminals scroll.
  mvwaddnstr(stdscr, bottom, 0, last.c_str(), getmaxx(stdscr) - 1);
  wrefresh(stdscr);
}

Screen::Key Screen::key() {
  switch (wgetch(stdscr)) {
    case 'q':
    case 'Q':
      return Key::quit;
    case 'r':
      return Key::forget;
    case KEY_RESIZE:
      return Key::resized;
    default:
      return Key::none;
  }
}

}  // namespace mixloop
