// SPDX-License-Identifier: MIT
#include "watch/channel_count.hpp"

namespace mixloop {

void ChannelCount::tick(std::int64_t seq) {
  if (!by_tick_) return;
  if (seq <= latest_) {
    ++repeated_;
    return;
  }
  if (latest_ >= 0) lost_ += static_cast<std::uint64_t>(seq - latest_ - 1);
  latest_ = seq;
}

ChannelView ChannelCount::view(Instant at) {
  using std::chrono::duration;
  while (samples_.size() > 1 && samples_[1].at <= at - std::chrono::seconds(1)) samples_.pop_front();
  const double span = duration<double>(at - samples_.front().at).count();
  const auto since = static_cast<double>(received_ - samples_.front().received);
  samples_.push_back({at, received_});
  ChannelView view{.name = name_, .received = received_, .repeated = repeated_, .bad = bad_};
  if (span > 0) view.rate_hz = since / span;
  if (last_) view.age = duration<double>(at - *last_).count();
  if (by_tick_) view.lost = lost_;
  return view;
}

}  // namespace mixloop
