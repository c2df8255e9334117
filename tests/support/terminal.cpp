// SPDX-License-Identifier: MIT
#include "tests/support/terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utmp.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

namespace mixloop {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Terminal::Terminal(const std::vector<std::string>& words, const std::vector<std::string>& environment,
                   int rows, int columns)
    : rows_(rows),
      columns_(columns),
      bottom_(rows - 1),
      cells_(static_cast<std::size_t>(rows * columns), ' ') {
  const winsize size{static_cast<unsigned short>(rows), static_cast<unsigned short>(columns), 0, 0};
  // The other end stays open here, so that its settings can be read when the command has gone.
  if (openpty(&master_, &slave_, nullptr, nullptr, &size) != 0) throw std::runtime_error("no terminal");
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  login_tty(slave_);
  for (const auto& entry : environment) putenv(const_cast<char*>(entry.c_str()));
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

Terminal::~Terminal() {
  if (status_ == -2) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(master_);
  close(slave_);
}

void Terminal::type(const std::string& keys) {
  if (write(master_, keys.data(), keys.size()) < 0) throw std::runtime_error("cannot type");
}

void Terminal::resize(int rows, int columns) {
  rows_ = rows, columns_ = columns, row_ = column_ = top_ = 0, bottom_ = rows - 1;
  cells_.assign(static_cast<std::size_t>(rows * columns), ' ');
  const winsize size{static_cast<unsigned short>(rows), static_cast<unsigned short>(columns), 0, 0};
  ioctl(master_, TIOCSWINSZ, &size);
}

bool Terminal::shows(const std::string& text, std::chrono::milliseconds limit) {
  const auto until = Clock::now() + limit;
  while (screen().find(text) == std::string::npos) {
    if (Clock::now() > until) return false;
    read_more(std::chrono::milliseconds(20));
  }
  return true;
}

int Terminal::wait(std::chrono::milliseconds limit) {
  const auto until = Clock::now() + limit;
  int status = 0;
  while (status_ == -2 && Clock::now() < until) {
    read_more(std::chrono::milliseconds(10));
    if (waitpid(pid_, &status, WNOHANG) == pid_)
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  while (read_more(std::chrono::milliseconds(0))) {
  }
  return status_ == -2 ? -1 : status_;
}

std::string Terminal::screen() const {
  std::string text;
  for (int row = 0; row < rows_; ++row) {
    const std::string line =
        cells_.substr(static_cast<std::size_t>(row * columns_), static_cast<std::size_t>(columns_));
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

termios Terminal::settings() const {
  termios settings{};
  tcgetattr(slave_, &settings);
  return settings;
}

bool Terminal::read_more(std::chrono::milliseconds limit) {
  pollfd fd{master_, POLLIN, 0};
  if (poll(&fd, 1, static_cast<int>(limit.count())) <= 0) return false;
  char bytes[4096];
  const ssize_t count = read(master_, bytes, sizeof bytes);
  if (count <= 0) return false;
  all_.append(bytes, static_cast<std::size_t>(count));
  for (ssize_t i = 0; i < count; ++i) take(bytes[i]);
  return true;
}

void Terminal::take(char c) {
  if (!pending_.empty() || c == '\033') {
    pending_ += c;
    if (pending_.size() == 1) return;
    const char kind = pending_[1];
    if (kind == '[') {
      if (pending_.size() == 2 || c < '@' || c > '~') return;
      sequence(pending_.substr(2, pending_.size() - 3), c);
    } else if (kind == 'M') {
      row_ == top_ ? scroll(-1) : void(row_ = std::max(row_ - 1, 0));
    } else if ((kind == '(' || kind == ')') && pending_.size() == 2) {
      return;  // the name of a character set follows
    }
    pending_.clear();
    return;
  }
  if (static_cast<unsigned char>(c) < ' ') return control(c);
  put(c);
}

void Terminal::put(char c) {
  if (column_ >= columns_) column_ = 0, row_ = std::min(row_ + 1, rows_ - 1);
  cells_[at()] = last_ = c;
  ++column_;
}

void Terminal::control(char c) {
  if (c == '\r') column_ = 0;
  if (c == '\n' && row_ == bottom_)
    scroll(1);
  else if (c == '\n')
    row_ = std::min(row_ + 1, rows_ - 1);
  if (c == '\b') column_ = std::max(column_ - 1, 0);
  if (c == '\t') column_ = std::min((column_ / 8 + 1) * 8, columns_ - 1);
}

// The lines from top_ to bottom_ go up; down where `lines` is negative.
void Terminal::scroll(int lines) {
  const auto width = static_cast<std::size_t>(columns_);
  const auto first = cells_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(top_) * width);
  const auto last =
      cells_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(bottom_ + 1) * width);
  const auto count = static_cast<std::ptrdiff_t>(
      static_cast<std::size_t>(std::min(std::abs(lines), bottom_ + 1 - top_)) * width);
  if (lines > 0) {
    std::fill(std::copy(first + count, last, first), last, ' ');
  } else {
    std::fill(first, std::copy_backward(first, last - count, last), ' ');
  }
}

void Terminal::erase(std::size_t from, std::size_t to) {
  std::fill(cells_.begin() + static_cast<std::ptrdiff_t>(from),
            cells_.begin() + static_cast<std::ptrdiff_t>(std::min(to, cells_.size())), ' ');
}

void Terminal::sequence(const std::string& parameters, char final) {
  const std::size_t second = parameters.find(';');
  const int given = std::atoi(parameters.c_str()), first = std::max(given, 1);
  const auto row_start = static_cast<std::size_t>(row_ * columns_),
             row_end = row_start + static_cast<std::size_t>(columns_);
  const std::size_t here = std::min(at(), row_end);
  if (final == 'H')
    row_ = first - 1,
    column_ = second == std::string::npos ? 0 : std::max(std::atoi(&parameters[second + 1]), 1) - 1;
  if (final == 'r')
    top_ = first - 1,
    bottom_ = (second == std::string::npos ? rows_ : std::atoi(&parameters[second + 1])) - 1;
  if (final == 'r') row_ = column_ = 0;
  if (final == 'S') scroll(first);
  if (final == 'T') scroll(-first);
  if (final == 'A') row_ -= first;
  if (final == 'B') row_ += first;
  if (final == 'C') column_ += first;
  if (final == 'D') column_ -= first;
  if (final == 'G') column_ = first - 1;
  if (final == 'd') row_ = first - 1;
  if (final == 'K') erase(given == 0 ? here : row_start, given == 1 ? here + 1 : row_end);
  if (final == 'J') erase(given == 0 ? here : 0, given == 1 ? here + 1 : cells_.size());
  if (final == 'X') erase(here, std::min(here + static_cast<std::size_t>(first), row_end));
  if (final == 'b')
    for (int i = 0; i < first; ++i) put(last_);
  if (final == '@')
    cells_.insert(here, static_cast<std::size_t>(first), ' '),
        cells_.erase(row_end, static_cast<std::size_t>(first));
  if (final == 'P')
    cells_.insert(row_end, static_cast<std::size_t>(first), ' '),
        cells_.erase(here, static_cast<std::size_t>(first));
  row_ = std::clamp(row_, 0, rows_ - 1);
  column_ = std::clamp(column_, 0, columns_);
}

}  // namespace mixloop
