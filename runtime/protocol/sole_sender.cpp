// SPDX-License-Identifier: MIT
#include "runtime/protocol/sole_sender.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mixloop {

std::string describe(const Rival& rival, const std::string& channel) {
  if (!rival.proved) return {};
  if (rival.taken == rival.refused)
    return fmt::format(
        "a second sender on {}: of tick {} came something else than what {} had said of it, "
        "and by that name; {} messages were not taken",
        channel, rival.tick, to_string(rival.taken), rival.messages);
  return fmt::format(
      "a second sender on {}: {} messages from {} were not taken, the first of tick {}; {} goes on "
      "being heard",
      channel, rival.messages, to_string(rival.refused), rival.tick, to_string(rival.taken));
}

void SoleSender::tell(const std::string& channel, const std::function<void(const std::string&)>& notice) {
  if (told_ || !rival_.proved) return;
  told_ = true;
  if (notice) notice(describe(rival_, channel));
}

void SoleSender::take(const Received& message, Instant at) {
  if (rival_.messages > 0 && sender_ == message.sender && message.sender == rival_.taken)
    rival_.proved = true;
  sender_ = message.sender;
  heard_ = at;
  last_.assign(message.data.begin(), message.data.end());
}

void SoleSender::refuse(Endpoint sender, std::int64_t tick) {
  if (rival_.messages == 0) rival_ = {.tick = tick, .taken = sender_.value_or(Endpoint{}), .refused = sender};
  ++rival_.messages;
}

bool SoleSender::contradicts(const Received& message, std::int64_t tick) {
  if (std::equal(last_.begin(), last_.end(), message.data.begin(), message.data.end())) return false;
  refuse(message.sender, tick);
  if (rival_.taken == rival_.refused) rival_.proved = true;
  return true;
}

}  // namespace mixloop
