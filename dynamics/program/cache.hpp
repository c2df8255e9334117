// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mixloop {

/// The directory that keeps built programs: $MIXLOOP_CACHE, else $XDG_CACHE_HOME/mixloop, else
/// ~/.cache/mixloop, else a directory of this user's in the temporary one. Made with mode 0700; nullopt
/// when it cannot be, or belongs to another user, or others may write to it.
std::optional<std::filesystem::path> cache_directory();

/// A shared object kept under a key. Its file ends with a seal, the SHA-256 of key and content.
class CacheEntry {
 public:
  CacheEntry(std::filesystem::path directory, std::string key);

  const std::filesystem::path& path() const { return path_; }
  /// True if the entry is whole, ours, and made for this key: only then may it be loaded.
  bool is_sound() const;
  /// Seals the file and puts it in place at once, over whatever was there. False if it cannot.
  bool adopt(const std::filesystem::path& built) const;

 private:
  std::string seal(const std::string& content) const;

  std::string key_;
  std::filesystem::path path_;
};

/// A directory of its own within the cache, removed at the end: where one builder works.
class Workshop {
 public:
  explicit Workshop(const std::filesystem::path& cache);
  ~Workshop();
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;

  explicit operator bool() const { return !path_.empty(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace mixloop
