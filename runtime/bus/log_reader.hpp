// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/wire.hpp"

namespace mixloop {

/// One message as a log holds it.
struct LogEvent {
  std::int64_t number = 0;       ///< the logger's own count
  std::int64_t received_us = 0;  ///< when the logger received it, us since 1970
  std::string_view channel;
  Bytes data;  ///< as on the wire: see Inbox, peek()
};

/// Reads an LCM event log, ours or lcm-logger's, event by event in the file's order, in the memory of its
/// longest event and a block.
///
/// The file is what LCM documents: per event ED A1 DA 01, int64 number, int64 us, int32 lengths of channel
/// and data, channel, data, all big endian. lcm's own reader is not used: it allocates whatever a damaged
/// length claims, complains on stderr, and doesn't say where a log is cut off.
///
/// A log may end in the middle of an event (its logger was killed, or is still writing) and may have such a
/// place inside (another logger appended to it): what isn't a whole event is skipped and said, by damage().
class LogReader {
 public:
  /// Throws InputError `cannot_read`, `empty_log` or `not_a_log`.
  explicit LogReader(const std::filesystem::path& file);

  /// The next event, valid until the next call; nullptr at the end. Throws RunFault("cannot_read") where the
  /// system can't read on.
  const LogEvent* next();

  std::int64_t position() const { return start_ + static_cast<std::int64_t>(at_); }  ///< bytes read so far
  std::int64_t size() const { return size_; }                                        ///< of the file, bytes

  std::int64_t skipped_bytes() const { return skipped_; }  ///< that are no whole event, before the last one
  std::int64_t cut_off_bytes() const { return cut_off_; }  ///< after the last whole event; known at the end
  /// What is wrong with what has been read, for a person, e.g. "the last event is cut off: 31 bytes from byte
  /// 7200 on are no whole event"; empty where nothing is.
  std::string damage() const;

 private:
  bool have(std::size_t bytes);
  bool read_event();
  bool note_too_long(std::uint64_t length);
  void skip_to_next();

  std::filesystem::path file_;
  std::ifstream in_;
  std::int64_t size_ = 0;
  std::vector<std::uint8_t> window_;  // the part of the file from start_ on, at_ bytes of it used
  std::int64_t start_ = 0;
  std::size_t at_ = 0;
  LogEvent event_;
  std::string too_long_;  ///< of the first event that claims more than it may have, in words
  std::int64_t skipped_ = 0, cut_off_ = 0, first_skipped_ = -1;
};

}  // namespace mixloop
