// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dynamics/program/descriptor.hpp"

namespace mixloop {

/// The directory that keeps built programs: $MIXLOOP_CACHE, else $XDG_CACHE_HOME/mixloop, else
/// ~/.cache/mixloop, else a directory of this user's in the temporary one. Made with mode 0700; without
/// links. nullopt when it cannot be made, or when others could put programs of theirs there: it, or one above
/// it, is not ours or may be written by others (above it, a sticky one like /tmp may). `complaint` then says
/// which, why, and what to do.
std::optional<std::filesystem::path> cache_directory(std::string& complaint);

/// A shared object kept under a key. Its file ends with a seal, the SHA-256 of key and content.
class CacheEntry {
 public:
  CacheEntry(std::filesystem::path directory, std::string key);

  const std::filesystem::path& path() const { return path_; }
  /// The entry's bytes, in memory that nothing can change any more, if it is whole, ours, and made for this
  /// key; else an empty one. What is loaded is what was looked at.
  Descriptor sound() const;
  /// Seals the file and puts it in place at once, over whatever was there. False if it cannot.
  bool adopt(const std::filesystem::path& built) const;

 private:
  std::string seal(const std::string& content) const;

  std::string key_;
  std::filesystem::path path_;
};

/// A directory of its own within the cache, removed at the end: where one builder works. Those that builders
/// left who were killed are removed with the first that comes after them.
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
  Descriptor in_use_;  ///< locked as long as the builder lives
};

}  // namespace mixloop
