// SPDX-License-Identifier: MIT
#include "watch/tick_assembly.hpp"

#include <algorithm>

namespace mixloop {

TickAssembly::TickAssembly(Options options)
    : options_(std::move(options)), slots_(static_cast<std::size_t>(options_.behind + kAhead)) {
  options_.patience = std::min(options_.patience, options_.behind);  // what the window leaves is given
}

void TickAssembly::begin(std::int64_t session, std::int64_t first) {
  session_ = session;
  from_ = next_ = std::clamp<std::int64_t>(first, 0, kFarthestTick);
  newest_ = from_ - 1;
  for (HeardTick& tick : slots_) tick.k = -1;
}

const HeardTick* TickAssembly::find(std::int64_t k) const {
  if (k < from_) return nullptr;
  const HeardTick& tick = slots_[static_cast<std::size_t>(k % size())];
  return tick.k == k ? &tick : nullptr;
}

/// `fresh`: the tick has its place in the window.
Taken TickAssembly::make_place(std::int64_t k, bool is_state) {
  if (k < from_) return Taken::late;
  if (k > (is_state ? std::min(newest_ + options_.farthest_jump, kFarthestTick) : from_ + size() - 1))
    return Taken::early;
  if (is_state && k > newest_) {
    newest_ = k;
    give_before(k - options_.patience + 1);
    from_ = std::max(from_, k - options_.behind + 1);
  }
  HeardTick& tick = slot(k);
  if (tick.k == k) return Taken::fresh;
  tick.k = k;
  std::apply([](auto&... part) { ((part.heard = false), ...); }, tick.parts_);
  return Taken::fresh;
}

void TickAssembly::give_before(std::int64_t end) {
  for (const std::int64_t last = std::min(end, from_ + size()); next_ < last; ++next_)
    if (const HeardTick* tick = find(next_); tick && options_.on_tick) options_.on_tick(*tick);
  next_ = std::max(next_, end);
}

void TickAssembly::give_complete() {
  if (!options_.complete) return;
  for (const HeardTick* tick = find(next_); tick && options_.complete(*tick); tick = find(next_))
    give_before(next_ + 1);
}

}  // namespace mixloop
