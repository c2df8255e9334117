// SPDX-License-Identifier: MIT
#include "runtime/bus/log_writer.hpp"

#include <fmt/format.h>
#include <lcm/eventlog.h>
#include <poll.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <map>
#include <thread>

#include "notation/errors.hpp"
#include "runtime/bus/backlog.hpp"
#include "runtime/bus/channel_filter.hpp"
#include "runtime/bus/receiver.hpp"

namespace mixloop {
/// One thread hears, so that no message waits for the disk; another writes.
struct LogWriter::Recording {
  explicit Recording(const BusOptions& bus, const std::filesystem::path& path)
      : file(path.string()),
        prefix(bus.prefix),
        state_channel(bus.prefix + "STATE"),
        receiver(multicast_group(bus.url), short_message_filter(), Receiver::Times::of_receipt),
        log(lcm_eventlog_create(file.c_str(), "w")) {
    if (!log) throw RunFault("cannot_write", "cannot write the log " + file);
    writing = std::thread([this] { write_all(); });
    hearing = std::thread([this] { hear_all(); });
  }
  ~Recording() {
    finish();
    if (log) lcm_eventlog_destroy(log);
  }

  void finish() {
    if (last_us == 0) last_us = realtime_us() + kUnderWay;
    if (hearing.joinable()) hearing.join();
    if (writing.joinable()) writing.join();
  }

  /// Until all is heard that the kernel received in time, whatever comes after it.
  void hear_all() {
    while (hear()) {
      pollfd fd{receiver.fd(), POLLIN, 0};
      poll(&fd, 1, last_us == 0 ? 50 : 1);
    }
    backlog.close();
  }

  /// Takes what waits; false once it is over.
  bool hear() {
    while (const Received* message = receiver.next()) {
      if (last_us != 0 && message->at_us > last_us) return false;
      if (message->channel.starts_with(prefix)) backlog.push(*message);
    }
    return last_us == 0 || realtime_us() <= last_us;
  }

  static std::int64_t realtime_us() {
    timespec at{};
    clock_gettime(CLOCK_REALTIME, &at);
    return at.tv_sec * std::int64_t{1'000'000} + at.tv_nsec / 1000;
  }

  void write_all() {
    for (Kept message; backlog.pop(message);) write(message);
  }

  void write(Kept& message) {
    lcm_eventlog_event_t event{};
    event.eventnum = summary.events++;
    event.timestamp = message.at_us;
    event.channellen = static_cast<int32_t>(message.channel.size());
    event.channel = message.channel.data();
    event.datalen = static_cast<int32_t>(message.data.size());
    event.data = message.data.data();
    if (!failed && lcm_eventlog_write_event(log, &event) != 0) failed = errno;
    if (message.channel == state_channel) count_gap(message.data);
  }

  void count_gap(Bytes state) {
    const auto header = peek(state);
    if (!header) return;
    const auto [known, first] = latest_ticks.emplace(header->session, -1);
    auto& latest = known->second;
    if (header->seq <= latest) return;
    summary.missing_ticks += header->seq - latest - 1;
    latest = header->seq;
  }

  std::string file, prefix, state_channel;
  Receiver receiver;
  lcm_eventlog_t* log;
  Backlog backlog;
  static constexpr std::int64_t kUnderWay = 20'000;  ///< us that a message may still be on its way
  std::atomic<std::int64_t> last_us{0};  ///< when the last message is taken, us since 1970; 0: not yet known
  LogSummary summary;
  std::map<std::int64_t, std::int64_t> latest_ticks;  ///< by session
  int failed = 0;  ///< the errno of the first event that could not be written
  std::thread writing, hearing;
};

LogWriter::LogWriter(const BusOptions& bus, const std::filesystem::path& file)
    : recording_(std::make_unique<Recording>(bus, file)) {}

LogWriter::~LogWriter() = default;

LogSummary LogWriter::finish() {
  Recording& recording = *recording_;
  recording.finish();
  if (recording.log && !recording.failed && std::fflush(recording.log->f) != 0) recording.failed = errno;
  if (recording.log) lcm_eventlog_destroy(recording.log);
  recording.log = nullptr;
  if (recording.failed)
    throw RunFault("cannot_write",
                   fmt::format("cannot write {}: {}", recording.file, std::strerror(recording.failed)));
  return recording.summary;
}

}  // namespace mixloop
