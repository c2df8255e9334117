// SPDX-License-Identifier: MIT
#include "dynamics/program/cache.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "notation/sha256.hpp"

namespace mixloop {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSealSize = 64;

std::optional<fs::path> wanted_directory() {
  auto absolute = [](const char* name) -> std::optional<fs::path> {
    const char* value = std::getenv(name);
    if (value == nullptr || !fs::path(value).is_absolute()) return std::nullopt;
    return fs::path(value);
  };
  if (auto chosen = absolute("MIXLOOP_CACHE")) return chosen;
  if (auto cache = absolute("XDG_CACHE_HOME")) return *cache / "mixloop";
  if (auto home = absolute("HOME"); home && ::access(home->c_str(), W_OK) == 0)
    return *home / ".cache" / "mixloop";
  std::error_code failed;
  const fs::path temporary = fs::temp_directory_path(failed);
  if (failed) return std::nullopt;
  return temporary / ("mixloop-" + std::to_string(::geteuid()));
}

// Ours, and nobody else may write to it.
bool is_private(const struct stat& info) { return info.st_uid == ::geteuid() && (info.st_mode & 022) == 0; }

// The content of a plain file of ours, never through a link.
std::optional<std::string> read_private_file(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  struct stat info {};
  std::string content;
  bool good = ::fstat(file, &info) == 0 && S_ISREG(info.st_mode) && is_private(info);
  if (good) content.resize(static_cast<std::size_t>(info.st_size));
  for (std::size_t done = 0; good && done < content.size();) {
    const ssize_t got = ::read(file, content.data() + done, content.size() - done);
    good = got > 0;
    if (good) done += static_cast<std::size_t>(got);
  }
  ::close(file);
  if (!good) return std::nullopt;
  return content;
}

}  // namespace

std::optional<fs::path> cache_directory() {
  const auto path = wanted_directory();
  if (!path) return std::nullopt;
  std::error_code failed;
  fs::create_directories(path->parent_path(), failed);
  ::mkdir(path->c_str(), 0700);
  struct stat info {};
  if (::lstat(path->c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || !is_private(info)) return std::nullopt;
  return path;
}

CacheEntry::CacheEntry(fs::path directory, std::string key)
    : key_(std::move(key)), path_(std::move(directory) / (key_ + ".so")) {}

std::string CacheEntry::seal(const std::string& content) const {
  Sha256 hash;
  hash.add(key_);
  hash.add(content);
  return hash.hex();
}

bool CacheEntry::is_sound() const {
  auto content = read_private_file(path_);
  if (!content || content->size() < kSealSize) return false;
  const std::string found = content->substr(content->size() - kSealSize);
  content->resize(content->size() - kSealSize);
  return found == seal(*content);
}

bool CacheEntry::adopt(const fs::path& built) const {
  const auto content = read_private_file(built);
  if (!content) return false;
  std::ofstream file(built, std::ios::binary | std::ios::app);
  file << seal(*content);
  file.close();
  if (!file || ::chmod(built.c_str(), 0700) != 0) return false;
  std::error_code failed;
  fs::rename(built, path_, failed);
  return !failed;
}

Workshop::Workshop(const fs::path& cache) {
  std::string pattern = (cache / "build-XXXXXX").string();
  if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
}

Workshop::~Workshop() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace mixloop
