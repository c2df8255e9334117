// SPDX-License-Identifier: MIT
#include "commands/shared/children.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLastLines = 6;

/// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void become(const std::vector<char*>& arguments, int errors, int inherited, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it died before the line above
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(errors, STDERR_FILENO);
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  if (inherited >= 0) fcntl(inherited, F_SETFD, 0);
  execv(arguments[0], arguments.data());
  const char* why = std::strerror(errno);
  if (write(STDERR_FILENO, why, std::strlen(why)) < 0) _exit(126);
  _exit(127);
}

}  // namespace

Child::Child(std::string name, const std::vector<std::string>& command, int inherited)
    : name_(std::move(name)) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0)
    throw RunFault("cannot_start", "no pipe for " + name_ + ": " + std::strerror(errno));
  std::vector<char*> arguments;
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(arguments, pipe_ends[1], inherited, parent);
  close(pipe_ends[1]);
  errors_ = pipe_ends[0];
  if (pid_ < 0) throw RunFault("cannot_start", "cannot start " + name_ + ": " + std::strerror(errno));
  setpgid(pid_, pid_);  // whichever of the two comes first
  fcntl(errors_, F_SETFL, O_NONBLOCK);
  pidfd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
}

Child::Child(Child&& other) noexcept
    : name_(std::move(other.name_)),
      pid_(std::exchange(other.pid_, -1)),
      pidfd_(std::exchange(other.pidfd_, -1)),
      errors_(std::exchange(other.errors_, -1)),
      partial_(std::move(other.partial_)),
      last_lines_(std::move(other.last_lines_)),
      exit_status_(other.exit_status_),
      killed_by_(other.killed_by_) {}

Child::~Child() {
  if (running()) {
    signal(SIGKILL);
    reap(true);
  }
  if (pidfd_ >= 0) close(pidfd_);
  if (errors_ >= 0) close(errors_);
}

void Child::read_errors(const std::function<void(const std::string&)>& line) {
  char buffer[4096];
  for (;;) {
    const ssize_t size = errors_ < 0 ? 0 : read(errors_, buffer, sizeof buffer);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return;  // nothing more for now
    if (size == 0) break;
    partial_.append(buffer, static_cast<std::size_t>(size));
    for (std::size_t end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n')) {
      last_lines_.push_back(partial_.substr(0, end));
      if (last_lines_.size() > kLastLines) last_lines_.erase(last_lines_.begin());
      line(last_lines_.back());
      partial_.erase(0, end + 1);
    }
    if (partial_.size() > 65536) partial_.clear();  // no line
  }
  if (errors_ >= 0) close(std::exchange(errors_, -1));
}

std::string Child::last_words() const {
  std::string words;
  for (const auto& line : last_lines_) words += (words.empty() ? "" : "\n") + line;
  if (!partial_.empty()) words += (words.empty() ? "" : "\n") + partial_;
  return words;
}

void Child::signal(int number) const {
  if (running()) kill(pid_, number);
}

bool Child::reap(bool wait) {
  if (!running()) return true;
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(pid_, &status, wait ? 0 : WNOHANG);
  while (ended < 0 && errno == EINTR);
  if (ended == 0) return false;
  pid_ = -1;
  if (WIFEXITED(status)) exit_status_ = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) killed_by_ = WTERMSIG(status);
  return true;
}

}  // namespace mixloop
