// SPDX-License-Identifier: MIT
#include "runtime/bus/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "notation/errors.hpp"
#include "notation/words.hpp"
#include "runtime/bus/big_endian.hpp"

namespace mixloop {
namespace {

constexpr std::uint8_t kMagic[] = {0xED, 0xA1, 0xDA, 0x01};
constexpr std::size_t kEventHeader = sizeof kMagic + 2 * 8 + 2 * 4;
constexpr std::size_t kBlock = 1 << 20;
constexpr std::uint64_t kLongestChannel = 1000;  // LCM's own bound on what it reads
// Nothing on a bus is longer: a damaged length must not take all memory.
constexpr std::uint64_t kLongestData = 256 << 20;

bool is_magic(const std::uint8_t* at) { return std::equal(std::begin(kMagic), std::end(kMagic), at); }

}  // namespace

LogReader::LogReader(const std::filesystem::path& file) : file_(file) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed))
    throw InputError("cannot_read", {file.string()}, "there is no such file; expected an LCM event log");
  if (!std::filesystem::is_regular_file(file, failed))
    throw InputError("cannot_read", {file.string()}, "is no file; expected an LCM event log");
  in_.open(file, std::ios::binary);
  if (!in_)
    throw InputError("cannot_read", {file.string()}, fmt::format("can't be read: {}", std::strerror(errno)));
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(file));
  if (size_ == 0)
    throw InputError("empty_log", {file.string()}, "is empty; expected an LCM event log with events in it");
  const bool has_begun = have(std::min<std::size_t>(sizeof kMagic, static_cast<std::size_t>(size_)));
  const std::span<const std::uint8_t> begins(window_.data(),
                                             static_cast<std::size_t>(std::min<std::int64_t>(4, size_)));
  if (!has_begun || !std::ranges::equal(begins, std::span(kMagic).first(begins.size()))) {
    std::string bytes;
    for (const std::uint8_t byte : begins) bytes += fmt::format("{:02X} ", byte);
    throw InputError("not_a_log", {file.string()},
                     fmt::format("begins with {}; expected an LCM event log, which begins with ED A1 DA 01",
                                 trimmed(bytes)));
  }
}

// Whether so many bytes are there from at_ on; reads another block where they aren't. Never past the size
// that the file had at first: a logger may still be writing.
bool LogReader::have(std::size_t bytes) {
  const std::size_t left = window_.size() - at_;
  if (left >= bytes) return true;
  if (static_cast<std::int64_t>(bytes) > size_ - position()) return false;
  window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(at_));
  start_ += static_cast<std::int64_t>(at_);
  at_ = 0;
  const auto unread = static_cast<std::size_t>(size_ - start_) - left;
  const std::size_t more = std::min(unread, std::max(kBlock, bytes - left));
  window_.resize(left + more);
  in_.read(reinterpret_cast<char*>(window_.data() + left), static_cast<std::streamsize>(more));
  if (in_.gcount() != static_cast<std::streamsize>(more))
    throw RunFault("cannot_read",
                   fmt::format("{}: byte {} can't be read; has the file become shorter?", file_.string(),
                               start_ + static_cast<std::int64_t>(left) + in_.gcount()));
  return true;
}

const LogEvent* LogReader::next() {
  const std::int64_t from = position();
  while (position() < size_) {
    const std::int64_t here = position();
    if (read_event()) {
      if (here > from && skipped_ == 0) first_skipped_ = from;
      skipped_ += here - from;
      return &event_;
    }
    skip_to_next();
  }
  cut_off_ += size_ - from;
  return nullptr;
}

// An event is whole where its lengths can be, its bytes are there, and the next event or the file's end
// follows.
bool LogReader::read_event() {
  if (!have(kEventHeader) || !is_magic(&window_[at_])) return false;
  const std::uint64_t channel_length = big_endian<std::uint32_t>(&window_[at_ + 20]),
                      data_length = big_endian<std::uint32_t>(&window_[at_ + 24]);
  if (channel_length == 0 || channel_length >= kLongestChannel) return false;
  if (data_length > kLongestData) return note_too_long(data_length);
  const std::size_t length = kEventHeader + channel_length + data_length;
  if (!have(length)) return false;
  if (have(length + sizeof kMagic) && !is_magic(&window_[at_ + length])) return false;
  const std::uint8_t* at = &window_[at_];
  event_ = {.number = big_endian<std::int64_t>(at + 4),
            .received_us = big_endian<std::int64_t>(at + 12),
            .channel = {reinterpret_cast<const char*>(at + kEventHeader), channel_length},
            .data = {at + kEventHeader + channel_length, data_length}};
  at_ += length;
  return true;
}

bool LogReader::note_too_long(std::uint64_t length) {
  if (too_long_.empty())
    too_long_ =
        fmt::format("the event at byte {} claims {} bytes of data, more than the {} that one may have",
                    position(), length, kLongestData);
  return false;
}

// Goes on to the next place past this one where an event may begin, or to the end.
void LogReader::skip_to_next() {
  ++at_;
  for (;;) {
    have(std::min<std::size_t>(kBlock, static_cast<std::size_t>(size_ - position())));
    const auto begin = window_.begin() + static_cast<std::ptrdiff_t>(at_);
    const auto found = std::search(begin, window_.end(), std::begin(kMagic), std::end(kMagic));
    at_ = static_cast<std::size_t>(found - window_.begin());
    if (found != window_.end() || position() == size_) return;
    at_ -= sizeof kMagic - 1;  // it may begin in this block's last bytes
  }
}

std::string LogReader::damage() const {
  std::string text;
  if (skipped_ > 0)
    text = fmt::format("{} bytes, the first at byte {}, are no whole event and are skipped", skipped_,
                       first_skipped_);
  if (!too_long_.empty()) text += (text.empty() ? "" : "; ") + too_long_;
  if (cut_off_ > 0)
    text += fmt::format("{}the log is cut off: its last {} bytes are no whole event",
                        text.empty() ? "" : "; ", cut_off_);
  return text;
}

}  // namespace mixloop
