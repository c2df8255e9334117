// SPDX-License-Identifier: MIT
#include "loop/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

/// Of what may be replaced: what isn't there yet, or is a file of the folder's own.
std::filesystem::path part_of(const std::filesystem::path& file) {
  std::error_code failure;
  const auto status = std::filesystem::symlink_status(file, failure);
  const bool is_own = !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
  return is_own ? std::filesystem::path(file.string() + ".part") : file;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)), part_(part_of(file_)) {
  out_.reset(std::fopen(part_.c_str(), "w"));
  if (!out_) fail(errno);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!published_ && part_ != file_) std::filesystem::remove(part_, ignored);
}

void OutputFile::write(std::string_view text) {
  hash_.add(text);
  if (std::fwrite(text.data(), 1, text.size(), out_.get()) != text.size()) fail(errno);
}

std::string OutputFile::publish() {
  if (std::fflush(out_.get()) != 0) fail(errno);
  if (std::fclose(out_.release()) != 0) fail(errno);
  std::error_code failure;
  if (part_ != file_) std::filesystem::rename(part_, file_, failure);
  if (failure) fail(failure.value());
  published_ = true;
  return hash_.hex();
}

void OutputFile::fail(int error) const {
  throw RunFault("cannot_write", "cannot write " + file_.string() + ": " + std::strerror(error));
}

std::string write_file(const std::filesystem::path& file, std::string_view text) {
  OutputFile out(file);
  out.write(text);
  return out.publish();
}

}  // namespace mixloop
