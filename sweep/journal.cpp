// SPDX-License-Identifier: MIT
#include "sweep/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr std::string_view kHead = "mixloop sweep journal 1 ";
constexpr std::uint32_t kMark = 0x53574d31;  // "1MWS"
constexpr std::int64_t kMostBytes = 1 << 30;

struct RecordHead {
  std::uint32_t mark = kMark, checksum = 0;
  std::int64_t first = 0, count = 0, size = 0;
};

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// Takes values off the front of bytes.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : bytes_(bytes) {}
  std::string_view text(std::size_t size) {
    if (size > bytes_.size()) throw std::invalid_argument("outcomes cut off");
    const std::string_view text = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return text;
  }
  template <class T>
  T value() {
    T value;
    std::memcpy(&value, text(sizeof(T)).data(), sizeof(T));
    return value;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

std::uint32_t checksum_of(RecordHead head, std::string_view outcomes) {
  head.checksum = 0;
  auto sum = crc32(0, reinterpret_cast<const Bytef*>(&head), sizeof head);
  sum = crc32_z(sum, reinterpret_cast<const Bytef*>(outcomes.data()), outcomes.size());
  return static_cast<std::uint32_t>(sum);
}

std::string head_of(const std::string& sweep) { return std::string(kHead) + sweep + "\n"; }

/// A file that is read at places.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : file_(file), descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail(errno);
  }
  ~Reader() { ::close(descriptor_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Fewer bytes where the file ends.
  std::string at(std::int64_t offset, std::int64_t size) const {
    std::string bytes(static_cast<std::size_t>(size), '\0');
    std::size_t have = 0;
    while (have < bytes.size()) {
      const ssize_t got = ::pread(descriptor_, bytes.data() + have, bytes.size() - have,
                                  static_cast<off_t>(offset) + static_cast<off_t>(have));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(errno);
      if (got == 0) break;
      have += static_cast<std::size_t>(got);
    }
    bytes.resize(have);
    return bytes;
  }

 private:
  [[noreturn]] void fail(int error) const {
    throw InputError("cannot_read", {file_.string()}, std::strerror(error));
  }

  std::filesystem::path file_;
  int descriptor_;
};

/// Goes over a journal's records, each as whole as its checksum says; where the last whole one ends.
std::int64_t scan(const std::filesystem::path& file, const std::string& sweep,
                  const std::function<void(const RecordHead&, std::int64_t offset)>& found) {
  const Reader reader(file);
  const std::string head = head_of(sweep);
  const std::string begin = reader.at(0, static_cast<std::int64_t>(head.size()));
  if (begin != head) {
    if (head.starts_with(begin)) return 0;  // cut off as it began
    throw InputError("another_sweep", {file.string()},
                     "it keeps the runs of another sweep; expected a folder of its own (--out)");
  }
  auto offset = static_cast<std::int64_t>(head.size());
  for (;;) {
    const std::string bytes = reader.at(offset, sizeof(RecordHead));
    if (bytes.size() < sizeof(RecordHead)) return offset;
    RecordHead record;
    std::memcpy(&record, bytes.data(), sizeof record);
    if (record.mark != kMark || record.count < 1 || record.size < 0 || record.size > kMostBytes)
      return offset;
    const std::int64_t outcomes = offset + static_cast<std::int64_t>(sizeof record);
    const std::string kept = reader.at(outcomes, record.size);
    if (std::ssize(kept) < record.size || checksum_of(record, kept) != record.checksum) return offset;
    found(record, outcomes);
    offset = outcomes + record.size;
  }
}

}  // namespace

std::string bytes_of(std::span<const Outcome> outcomes) {
  std::string bytes;
  for (const Outcome& outcome : outcomes) {
    put(bytes, outcome.end);
    put(bytes, static_cast<std::uint8_t>(outcome.code.size()));
    put(bytes, static_cast<std::uint8_t>(outcome.sha256.size()));
    bytes += outcome.code + outcome.sha256;
    for (const double value : outcome.values) put(bytes, value);
  }
  return bytes;
}

std::vector<Outcome> outcomes_in(std::string_view bytes, std::int64_t first, std::size_t values) {
  std::vector<Outcome> outcomes;
  for (Taker taker(bytes); !taker.empty();) {
    Outcome outcome{.run = first + std::ssize(outcomes)};
    const auto end = taker.value<std::uint8_t>();
    if (end >= kRunEnds) throw std::invalid_argument("no such end of a run");
    outcome.end = static_cast<RunEnd>(end);
    const auto code = taker.value<std::uint8_t>(), sha256 = taker.value<std::uint8_t>();
    outcome.code = taker.text(code);
    outcome.sha256 = taker.text(sha256);
    for (std::size_t i = 0; i < values; ++i) outcome.values.push_back(taker.value<double>());
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

Journal::Journal(std::filesystem::path file, const std::string& sweep)
    : file_(std::move(file)), descriptor_(::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0) fail(errno);
  size_ = scan(file_, sweep, [](const RecordHead&, std::int64_t) {});
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) fail(errno);
  if (size_ == 0) write(head_of(sweep));
}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Journal::append(std::span<const Outcome> outcomes) {
  if (outcomes.empty()) return;
  const std::string bytes = bytes_of(outcomes);
  RecordHead head{.first = outcomes.front().run, .count = std::ssize(outcomes), .size = std::ssize(bytes)};
  head.checksum = checksum_of(head, bytes);
  std::string record;
  put(record, head);
  write(record + bytes);
}

void Journal::write(std::string_view bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t put = ::pwrite(descriptor_, bytes.data() + written, bytes.size() - written,
                                 static_cast<off_t>(size_) + static_cast<off_t>(written));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) {
      const int error = errno;
      if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) fail(errno);
      fail(error);
    }
    written += static_cast<std::size_t>(put);
  }
  size_ += std::ssize(bytes);
}

void Journal::sync() {
  if (::fdatasync(descriptor_) != 0) fail(errno);
}

void Journal::fail(int error) const {
  throw RunFault("cannot_write", fmt::format("cannot write {}: {}; what it keeps already is whole: with room "
                                             "there, the same command goes on",
                                             file_.string(), std::strerror(error)));
}

KeptRuns::KeptRuns(const std::vector<std::filesystem::path>& files, const std::string& sweep,
                   std::size_t values)
    : files_(files), values_(values) {
  for (std::size_t i = 0; i < files_.size(); ++i)
    scan(files_[i], sweep, [&](const RecordHead& record, std::int64_t offset) {
      records_.push_back({{record.first, record.count}, i, offset, record.size});
    });
  std::ranges::stable_sort(records_, {}, [](const Record& record) { return record.runs.first; });
}

std::vector<Runs> KeptRuns::done() const {
  std::vector<Runs> done;
  for (const Record& record : records_) done.push_back(record.runs);
  return done;
}

void KeptRuns::each(const std::function<void(const Outcome&)>& told) const {
  std::vector<std::unique_ptr<Reader>> readers;
  for (const auto& file : files_) readers.push_back(std::make_unique<Reader>(file));
  std::int64_t next = 0;
  for (const Record& record : records_) {
    if (record.runs.end() <= next) continue;
    const std::string bytes = readers[record.file]->at(record.offset, record.size);
    for (const Outcome& outcome : outcomes_in(bytes, record.runs.first, values_))
      if (outcome.run >= next) told(outcome);
    next = record.runs.end();
  }
}

}  // namespace mixloop
