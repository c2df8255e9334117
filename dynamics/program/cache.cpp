// SPDX-License-Identifier: MIT
#include "dynamics/program/cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
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
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (!file || ::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode) || !is_private(info))
    return std::nullopt;
  std::string content(static_cast<std::size_t>(info.st_size), '\0');
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t got = ::read(file.get(), content.data() + done, content.size() - done);
    if (got <= 0) return std::nullopt;
    done += static_cast<std::size_t>(got);
  }
  return content;
}

// The same bytes in memory of ours, sealed.
Descriptor in_memory(std::string_view content) {
  Descriptor file(::memfd_create("mixloop", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  while (file && !content.empty()) {
    const ssize_t written = ::write(file.get(), content.data(), content.size());
    if (written <= 0) return {};
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  constexpr int kSeals = F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
  if (!file || ::fcntl(file.get(), F_ADD_SEALS, kSeals) != 0) return {};
  return file;
}

// A user namespace shows whoever it doesn't know, root of the machine too, as this one.
bool is_root_or_unknown(uid_t owner) {
  static const uid_t unknown = [] {
    std::ifstream map("/proc/self/uid_map"), overflow("/proc/sys/kernel/overflowuid");
    std::uint64_t first = 0, outside = 0, count = 0, id = 0;
    const bool knows_all = !(map >> first >> outside >> count) || count >= 0xffffffff;
    return !knows_all && overflow >> id ? static_cast<uid_t>(id) : 0;
  }();
  return owner == 0 || owner == unknown;
}

// Why others may put what they like at a directory's name, by way of one above it; nothing where they can't.
std::optional<std::string> open_way(const fs::path& directory) {
  for (fs::path above = directory.parent_path();; above = above.parent_path()) {
    struct stat info {};
    if (::lstat(above.c_str(), &info) != 0)
      return fmt::format("{}: {}", above.string(), std::strerror(errno));
    if (info.st_uid != ::geteuid() && !is_root_or_unknown(info.st_uid))
      return fmt::format("{} belongs to another user ({})", above.string(), info.st_uid);
    if ((info.st_mode & 022) != 0 && (info.st_mode & S_ISVTX) == 0)
      return fmt::format("others may write to {} (mode {:o}; chmod go-w takes that away)", above.string(),
                         info.st_mode & 07777);
    if (above == above.root_path()) return std::nullopt;
  }
}

// Why a directory can't be the cache; nothing where it can.
std::optional<std::string> unfit(const fs::path& directory) {
  struct stat info {};
  if (::lstat(directory.c_str(), &info) != 0)
    return fmt::format("cannot make {}: {}", directory.string(), std::strerror(errno));
  if (!S_ISDIR(info.st_mode)) return fmt::format("{} is no directory", directory.string());
  if (info.st_uid != ::geteuid())
    return fmt::format("{} belongs to another user ({})", directory.string(), info.st_uid);
  if (!is_private(info))
    return fmt::format("others may write to {} (mode {:o}; chmod go-w takes that away)", directory.string(),
                       info.st_mode & 07777);
  return open_way(directory);
}

constexpr const char* kWorkshop = "build-";

// Whether nobody else has it, who then has it as long as `directory` is open.
bool is_taken(const Descriptor& directory) { return ::flock(directory.get(), LOCK_EX | LOCK_NB) == 0; }

Descriptor open_directory(const fs::path& path) {
  return Descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

void remove_abandoned(const fs::path& cache) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(cache, failed)) {
    if (!entry.path().filename().string().starts_with(kWorkshop)) continue;
    if (const Descriptor left = open_directory(entry.path()); left && is_taken(left))
      fs::remove_all(entry.path(), failed);
  }
}

}  // namespace

std::optional<fs::path> cache_directory(std::string& complaint) {
  const auto wanted = wanted_directory();
  std::error_code failed;
  if (wanted) fs::create_directories(wanted->parent_path(), failed);
  const fs::path above = wanted ? fs::canonical(wanted->parent_path(), failed) : fs::path();
  if (above.empty()) {
    complaint = "no directory to keep programs in: set $MIXLOOP_CACHE to one of yours";
    if (wanted) complaint += fmt::format(" (cannot make {}: {})", wanted->string(), failed.message());
    return std::nullopt;
  }
  const fs::path path = above / wanted->filename();
  ::mkdir(path.c_str(), 0700);
  const auto why = unfit(path);
  if (!why) return path;
  complaint = *why +
              ", so that a program kept there could be another's; set $MIXLOOP_CACHE to a directory "
              "that only you can write to";
  return std::nullopt;
}

CacheEntry::CacheEntry(fs::path directory, std::string key)
    : key_(std::move(key)), path_(std::move(directory) / (key_ + ".so")) {}

std::string CacheEntry::seal(const std::string& content) const {
  Sha256 hash;
  hash.add(key_);
  hash.add(content);
  return hash.hex();
}

Descriptor CacheEntry::sound() const {
  auto content = read_private_file(path_);
  if (!content || content->size() < kSealSize) return {};
  const std::string found = content->substr(content->size() - kSealSize);
  content->resize(content->size() - kSealSize);
  return found == seal(*content) ? in_memory(*content) : Descriptor();
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
  remove_abandoned(cache);
  // One that somebody takes for abandoned before it is locked is made anew.
  for (int tries = 0; path_.empty() && tries < 10; ++tries) {
    std::string name = (cache / kWorkshop).string() + "XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) return;
    in_use_ = open_directory(name);
    struct stat info {};
    const bool is_theirs = in_use_ && !is_taken(in_use_) && errno == EWOULDBLOCK;
    if (in_use_ && !is_theirs && ::fstat(in_use_.get(), &info) == 0 && info.st_nlink > 0) path_ = name;
  }
}

Workshop::~Workshop() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace mixloop
