// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace mixloop {

/// Files that are written together and become visible together: until publish() they are named NAME.part, and
/// without it they are removed again, so that no half of anything passes for the whole.
class CsvFolder {
 public:
  /// Makes the folder where it isn't there. Throws RunFault("cannot_write").
  explicit CsvFolder(const std::filesystem::path& folder);
  ~CsvFolder();
  CsvFolder(const CsvFolder&) = delete;
  CsvFolder& operator=(const CsvFolder&) = delete;

  /// Opens another file; the number to write into it by. Its name is `stem`.csv, with what a file's name
  /// should not have replaced, and numbered where that is taken.
  std::size_t open(std::string_view stem);
  std::string name(std::size_t file) const { return files_[file].name; }
  void write(std::size_t file, std::string_view text);

  /// Closes all files and gives them their names. Throws RunFault("cannot_write") where one isn't whole.
  void publish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct File {
    std::string name;
    std::unique_ptr<std::FILE, Close> out;
  };
  std::filesystem::path part(const File& file) const { return folder_ / (file.name + ".part"); }

  std::filesystem::path folder_;
  std::vector<File> files_;
};

}  // namespace mixloop
