// SPDX-License-Identifier: MIT
#include "sweep/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "loop/output_file.hpp"
#include "loop/output_folder.hpp"
#include "notation/utf8.hpp"
#include "sweep/kept_sweep.hpp"

namespace mixloop {
namespace {

/// Of a sweep's file of settings: scalars by their keys.
void require_same(const NodePtr& kept, const Sweep& sweep) {
  for (const auto& [key, value] : sweep.settings()) {
    if (key == "experiment") continue;  // by its contents: it may have been called from elsewhere
    const NodePtr found = kept->kind == Node::Kind::mapping ? find_entry(*kept, key) : nullptr;
    if (found && found->text == value) continue;
    throw InputError(
        "another_sweep", found ? found->place : kept->place,
        fmt::format("the folder keeps a sweep with {}, and now {} is asked for; expected the "
                    "same settings to go on with it, or another folder (--out)",
                    found ? key + ": " + in_quotes(found->text) : "no " + in_quotes(key), in_quotes(value)));
  }
  for (const auto& entry : kept->entries)
    if (std::ranges::find(sweep.settings(), entry.key, &Sweep::Settings::value_type::first) ==
        sweep.settings().end())
      throw InputError(
          "another_sweep", entry.place,
          fmt::format("the folder keeps a sweep with {}, which isn't asked for now; expected the "
                      "same settings to go on with it, or another folder (--out)",
                      in_quotes(entry.key)));
}

}  // namespace

std::string own_name() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}", ::getpid(), host.data());
}

FileLock::FileLock(std::filesystem::path file, Kind kind, bool waits)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  const auto fail = [&](int error) {
    if (descriptor_ >= 0) ::close(descriptor_);
    throw RunFault("cannot_write", "cannot lock " + file.string() + ": " + std::strerror(error));
  };
  if (descriptor_ < 0) fail(errno);
  const int how = (kind == Kind::alone ? LOCK_EX : LOCK_SH) | (waits ? 0 : LOCK_NB);
  int taken = 0;
  do taken = ::flock(descriptor_, how);
  while (taken != 0 && errno == EINTR);
  if (taken != 0 && errno != EWOULDBLOCK) fail(errno);
  if (taken != 0) {
    std::string who;
    std::getline(std::ifstream(file), who);
    ::close(descriptor_);
    throw InputError("in_use", {file.string()},
                     (who.empty() ? "another process" : who) +
                         " is at work on this sweep; expected it to end first, or another folder (--out)");
  }
  if (kind == Kind::shared && waits) return;
  const std::string name = own_name() + "\n";
  if (::ftruncate(descriptor_, 0) != 0 ||
      ::pwrite(descriptor_, name.data(), name.size(), 0) != std::ssize(name))
    fail(errno);
}

FileLock::~FileLock() { ::close(descriptor_); }

SweepFolder::SweepFolder(std::filesystem::path folder, const Sweep& sweep, const Part& part)
    : folder_(std::move(folder)), part_(part) {
  prepare_folder(folder_);
  const auto lock = [&](const std::string& name, FileLock::Kind kind) {
    locks_.push_back(std::make_unique<FileLock>(folder_ / name, kind));
  };
  lock("lock", part.is_whole() ? FileLock::Kind::alone : FileLock::Kind::shared);
  if (!part.is_whole()) lock("lock" + suffix(), FileLock::Kind::alone);
  keep_settings(sweep);
}

std::string SweepFolder::suffix() const {
  return part_.is_whole() ? "" : fmt::format(".{}-of-{}", part_.index + 1, part_.of);
}

std::filesystem::path SweepFolder::journal() const { return folder_ / ("journal" + suffix()); }

std::vector<std::filesystem::path> journals_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const std::string name = entry.path().filename(); name == "journal" || name.starts_with("journal."))
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// Parts that begin together write it once.
void SweepFolder::keep_settings(const Sweep& sweep) const {
  const FileLock alone(folder_ / "lock.settings", FileLock::Kind::alone, true);
  const auto file = folder_ / "sweep.yaml";
  if (std::filesystem::exists(file)) {
    require_same(read_document(file), sweep);
    return write_kept_sweep(folder_, sweep);  // of an older folder, or called from elsewhere
  }
  std::string text = "# What this folder's runs are of; written by mixloop sweep.\n";
  for (const auto& [key, value] : sweep.settings())
    text += fmt::format("{}: {}\n", nlohmann::json(key).dump(), nlohmann::json(value).dump());
  write_file(file, text);
  write_kept_sweep(folder_, sweep);
}

}  // namespace mixloop
