// SPDX-License-Identifier: MIT
#include "runtime/protocol/timing_sender.hpp"

namespace mixloop {
namespace {

constexpr auto kInterval = std::chrono::milliseconds(200);

void fill(timing_t& m, const PlantReport& report, const DeadlineCounts& deadlines) {
  const auto count = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  m.missed = deadlines.missed;
  m.longest_miss = deadlines.longest_miss;
  m.success_last_100 = deadlines.success_last_100;
  m.resent = count(report.resent);
  m.overruns = count(report.overruns);
  m.slipped = report.slipped.count();

  m.round_trip_p50 = report.round_trip.quantile(0.5).count();
  m.round_trip_p99 = report.round_trip.quantile(0.99).count();
  m.round_trip_max = report.round_trip.max().count();
  m.wake_up_p50 = report.wake_up.quantile(0.5).count();
  m.wake_up_p99 = report.wake_up.quantile(0.99).count();
  m.wake_up_max = report.wake_up.max().count();
  m.relative_error = Histogram::kRelativeError;

  for (const RejectRow& row : kRejects)
    if (row.timed != nullptr) m.*row.timed = count(report.rejects.of(row.cause));
  m.rejected_session += count(report.rejects.of(Reject::sender));
}

}  // namespace

TimingSender::TimingSender(Bus& bus, const Header& header)
    : channel_(bus.channel("TIMING")), message_(header.n) {}

bool TimingSender::send_where_due(Bus& bus, const Header& header, const PlantReport& report,
                                  const DeadlineCounts& deadlines) {
  const Instant at = now();
  if (at < next_) return false;
  next_ = at + kInterval;
  set_header(message_.message, header);
  fill(message_.message, report, deadlines);
  bus.publish(channel_, message_.encode());
  return true;
}

}  // namespace mixloop
