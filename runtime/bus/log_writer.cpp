// SPDX-License-Identifier: MIT
#include "runtime/bus/log_writer.hpp"

#include <fmt/format.h>
#include <lcm/eventlog.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>

#include "notation/errors.hpp"

namespace mixloop {

struct LogWriter::Recording {
  lcm_t* lcm = nullptr;
  lcm_eventlog_t* log = nullptr;
  std::string file, state_channel;
  std::atomic<bool> over{false};
  LogSummary summary;
  std::int64_t latest_tick = -1;
  std::int64_t session = 0;
  int failed = 0;  ///< the errno of the first event that could not be written
  std::thread thread;

  ~Recording() {
    over = true;
    if (thread.joinable()) thread.join();
    if (log) lcm_eventlog_destroy(log);
    if (lcm) lcm_destroy(lcm);
  }

  static void on_message(const lcm_recv_buf_t* received, const char* channel, void* self) {
    static_cast<Recording*>(self)->write(*received, channel);
  }

  void write(const lcm_recv_buf_t& received, const char* channel) {
    lcm_eventlog_event_t event{};
    event.eventnum = summary.events++;
    event.timestamp = received.recv_utime;
    event.channellen = static_cast<int32_t>(std::char_traits<char>::length(channel));
    event.channel = const_cast<char*>(channel);
    event.datalen = static_cast<int32_t>(received.data_size);
    event.data = received.data;
    if (!failed && lcm_eventlog_write_event(log, &event) != 0) failed = errno;
    if (state_channel == channel)
      count_gap({static_cast<const std::uint8_t*>(received.data), received.data_size});
  }

  void count_gap(Bytes state) {
    const auto header = peek(state);
    if (!header) return;
    if (header->session != session) session = header->session, latest_tick = -1;
    if (header->seq > latest_tick) {
      summary.missing_ticks += header->seq - latest_tick - 1;
      latest_tick = header->seq;
    }
  }

  void record() {
    while (!over) drain(50);
    while (drain(20)) {
    }
  }

  bool drain(int timeout_ms) {
    pollfd fd{lcm_get_fileno(lcm), POLLIN, 0};
    if (poll(&fd, 1, timeout_ms) <= 0) return false;
    return lcm_handle(lcm) == 0;
  }
};

LogWriter::LogWriter(const BusOptions& bus, const std::filesystem::path& file)
    : recording_(std::make_unique<Recording>()) {
  Recording& recording = *recording_;
  recording.file = file.string();
  recording.state_channel = bus.prefix + "STATE";
  recording.log = lcm_eventlog_create(file.c_str(), "w");
  if (!recording.log) throw RunFault("cannot_write", "cannot write the log " + file.string());
  recording.lcm = lcm_create(bus.url.c_str());
  if (!recording.lcm) throw RunFault("bus", "no LCM bus at " + bus.url);
  auto* subscription =
      lcm_subscribe(recording.lcm, (bus.prefix + ".*").c_str(), &Recording::on_message, &recording);
  lcm_subscription_set_queue_capacity(subscription, 100'000);
  recording.thread = std::thread([&recording] { recording.record(); });
}

LogWriter::~LogWriter() = default;

LogSummary LogWriter::finish() {
  Recording& recording = *recording_;
  recording.over = true;
  if (recording.thread.joinable()) recording.thread.join();
  if (recording.log && !recording.failed && std::fflush(recording.log->f) != 0) recording.failed = errno;
  if (recording.log) lcm_eventlog_destroy(recording.log);
  recording.log = nullptr;
  if (recording.failed)
    throw RunFault("cannot_write",
                   fmt::format("cannot write {}: {}", recording.file, std::strerror(recording.failed)));
  return recording.summary;
}

}  // namespace mixloop
