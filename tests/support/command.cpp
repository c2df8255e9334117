// SPDX-License-Identifier: MIT
#include "tests/support/command.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace mixloop {

std::string bytes_of(const std::string& file) {
  std::stringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "mixloop-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no scratch folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string ScratchFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name) << text;
  return file(name);
}

Command::Command(const std::vector<std::string>& words, const std::vector<std::string>& environment) {
  const std::string out = folder_.file("out"), err = folder_.file("err");
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
  for (const auto& entry : environment) putenv(const_cast<char*>(entry.c_str()));
  execv(arguments[0], arguments.data());
  _exit(127);
}

Command::~Command() {
  if (status_ != -2) return;
  signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool Command::running() {
  if (status_ != -2) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

void Command::signal(int number) const { kill(pid_, number); }

std::vector<int> Command::children() const {
  std::istringstream list(
      bytes_of("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) + "/children"));
  std::vector<int> pids;
  for (int pid = 0; list >> pid;) pids.push_back(pid);
  return pids;
}

int Command::wait(std::chrono::milliseconds limit) {
  if (!eventually([&] { return !running(); }, limit)) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
    status_ = -1;
  }
  return status_;
}

std::string Command::out() const { return bytes_of(folder_.file("out")); }
std::string Command::err() const { return bytes_of(folder_.file("err")); }

}  // namespace mixloop
