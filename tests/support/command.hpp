// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace mixloop {

/// All bytes of a file; none where there is no such file.
std::string bytes_of(const std::string& file);

/// A folder of a test's own, gone with it.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file into it; its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

/// A command that is running, its output collected; killed with the test.
class Command {
 public:
  /// The first word is a path; `environment` is added to the test's own, as NAME=value.
  explicit Command(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});
  ~Command();
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  int pid() const { return pid_; }
  bool running();
  void signal(int number) const;
  /// Of the processes that it started and that are still there.
  std::vector<int> children() const;

  /// The exit status, 128 + the signal that ended it, or -1 (then it is killed) after the limit.
  int wait(std::chrono::milliseconds limit = std::chrono::seconds(200));
  std::string out() const;
  std::string err() const;
  nlohmann::json json() const { return nlohmann::json::parse(out()); }

 private:
  ScratchFolder folder_;
  int pid_ = -1;
  int status_ = -2;  ///< -2: not collected
};

/// Waits for a condition; false after the limit.
template <class Condition>
bool eventually(const Condition& condition, std::chrono::milliseconds limit = std::chrono::seconds(20)) {
  const auto until = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace mixloop
