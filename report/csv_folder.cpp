// SPDX-License-Identifier: MIT
#include "report/csv_folder.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "loop/output_folder.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

std::string fit_for_a_file(std::string_view stem) {
  std::string name(stem.substr(0, 200));
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
  if (name.empty() || name.front() == '.') name.insert(0, "_");
  return name;
}

}  // namespace

CsvFolder::CsvFolder(const std::filesystem::path& folder) : folder_(folder) { prepare_folder(folder); }

CsvFolder::~CsvFolder() {
  for (const File& file : files_) {
    std::error_code ignored;
    std::filesystem::remove(part(file), ignored);
  }
}

std::size_t CsvFolder::open(std::string_view stem) {
  const std::string fit = fit_for_a_file(stem);
  std::string name = fit + ".csv";
  const auto taken = [&] {
    return std::any_of(files_.begin(), files_.end(), [&](const File& other) { return other.name == name; });
  };
  for (int number = 2; taken(); ++number) name = fit + "_" + std::to_string(number) + ".csv";
  File file{.name = name};
  file.out.reset(std::fopen(part(file).c_str(), "w"));
  if (!file.out)
    throw RunFault("cannot_write", "cannot write " + part(file).string() + ": " + std::strerror(errno));
  files_.push_back(std::move(file));
  return files_.size() - 1;
}

void CsvFolder::write(std::size_t file, std::string_view text) {
  std::FILE* out = files_[file].out.get();
  if (std::fwrite(text.data(), 1, text.size(), out) != text.size())
    throw RunFault("cannot_write",
                   "cannot write " + part(files_[file]).string() + ": " + std::strerror(errno));
}

void CsvFolder::publish() {
  for (File& file : files_)
    if (std::fclose(file.out.release()) != 0)
      throw RunFault("cannot_write",
                     "cannot write all of " + part(file).string() + ": " + std::strerror(errno));
  for (const File& file : files_) {
    std::error_code failed;
    std::filesystem::rename(part(file), folder_ / file.name, failed);
    if (failed)
      throw RunFault("cannot_write",
                     "cannot write " + (folder_ / file.name).string() + ": " + failed.message());
  }
}

}  // namespace mixloop
