// SPDX-License-Identifier: MIT
#include "dynamics/program/compiler.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "notation/long_work.hpp"

extern char** environ;

namespace mixloop {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> on_the_path(const std::string& name) {
  if (name.find('/') != std::string::npos)
    return ::access(name.c_str(), X_OK) == 0 ? std::optional<fs::path>(name) : std::nullopt;
  const char* path = std::getenv("PATH");
  std::istringstream directories(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string directory; std::getline(directories, directory, ':');) {
    const fs::path candidate = fs::path(directory) / name;
    if (!directory.empty() && ::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return std::nullopt;
}

std::optional<Compiler> compiler_at(const std::string& name, const std::vector<std::string>& flags,
                                    const char* suffix = ".cpp") {
  const auto path = on_the_path(name);
  if (!path) return std::nullopt;
  std::error_code failed;
  const fs::path file = fs::canonical(*path, failed);
  struct stat info {};
  if (failed || ::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  std::ostringstream identity;
  identity << file.string() << ' ' << info.st_size << ' ' << info.st_mtim.tv_sec << '.'
           << info.st_mtim.tv_nsec;
  return Compiler{*path, identity.str(), flags, suffix};
}

/// Waits for a compiler's end. Throws Interrupted, the compiler ended.
bool succeeds(pid_t child) {
  int status = -1;
  const auto reap = [&](int how) {
    pid_t ended = 0;
    do ended = ::waitpid(child, &status, how);
    while (ended < 0 && errno == EINTR);
    return ended != 0;
  };
  try {
    while (!reap(WNOHANG)) {
      work_goes_on();
      ::poll(nullptr, 0, 2);
    }
  } catch (const Interrupted&) {
    ::kill(-child, SIGKILL);
    reap(0);
    throw;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::optional<Compiler> find_compiler() {
  if (const char* chosen = std::getenv("MIXLOOP_CXX")) return compiler_at(chosen, machine_code_flags());
  const char* cxx = std::getenv("CXX");
  for (const char* name : {cxx != nullptr ? cxx : "c++", "c++", "g++", "clang++"})
    if (auto compiler = compiler_at(name, machine_code_flags())) return compiler;
  return std::nullopt;
}

// For no architecture in particular: the driver makes the device's own code of it. No contraction, either.
std::optional<Compiler> find_cuda_compiler() {
  static const std::vector<std::string> flags = {"-std=c++17", "-O3",        "-fmad=false",
                                                 "-shared",    "-Xcompiler", "-fPIC,-ffp-contract=off"};
  if (const char* chosen = std::getenv("MIXLOOP_NVCC")) return compiler_at(chosen, flags, ".cu");
  for (const char* name : {"nvcc", "/usr/local/cuda/bin/nvcc"})
    if (auto compiler = compiler_at(name, flags, ".cu")) return compiler;
  return std::nullopt;
}

const std::vector<std::string>& machine_code_flags() {
  static const std::vector<std::string> flags = {"-std=c++17", "-O2", "-march=native", "-ffp-contract=off",
                                                 "-fno-math-errno", "-fno-plt", "-fPIC", "-shared",
                                                 // GCC 12 fuses the sums and differences of products that it
                                                 // has put into one vector, in spite of contract=off.
                                                 "-fno-tree-slp-vectorize",
                                                 // Before registers are given, too: 0.95 of the time
                                                 // (bench/README.md).
                                                 "-fschedule-insns"};
  return flags;
}

bool build_shared_object(const Compiler& compiler, const fs::path& source, const fs::path& result,
                         std::string& complaint) {
  std::vector<std::string> words{compiler.path.string()};
  words.insert(words.end(), compiler.flags.begin(), compiler.flags.end());
  words.insert(words.end(), {"-o", result.string(), source.string()});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const fs::path log = source.string() + ".log";
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = -1;
  posix_spawnattr_t attributes;  // a process group of its own, so that all of it can be ended
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int failed = ::posix_spawn(&child, arguments[0], &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failed == 0 && succeeds(child)) return true;
  std::ifstream said(log);
  complaint.assign(std::istreambuf_iterator<char>(said), {});
  complaint.resize(std::min<std::size_t>(complaint.size(), 2000));
  return false;
}

}  // namespace mixloop
