// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "notation/sha256.hpp"

namespace mixloop {

/// A file that appears whole: until publish() it is named NAME.part, NAME stays as it was, and without
/// publish() the part is removed again. What is no regular file (a device, a pipe) is written directly. Every
/// failure throws RunFault("cannot_write") with the system's reason.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  /// Closes it and gives it its name. The SHA-256 of what was written.
  std::string publish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(int error) const;

  std::filesystem::path file_, part_;  ///< the same where it is written directly
  std::unique_ptr<std::FILE, Close> out_;
  Sha256 hash_;
  bool published_ = false;
};

/// Writes a file at once; its SHA-256.
std::string write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace mixloop
