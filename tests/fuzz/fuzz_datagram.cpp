// SPDX-License-Identifier: MIT
// A datagram as it comes off the wire.
#include <algorithm>
#include <vector>

#include "runtime/bus/receiver.hpp"
#include "tests/fuzz/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mixloop;
  // Of exactly this size, so that a byte too many is seen.
  const std::vector<std::uint8_t> datagram(data, data + size);
  Received message;
  if (!read_short_message(datagram, message)) return 0;
  require(message.channel.size() <= 63, "a channel's name is as long as LCM's may be");
  require(message.channel.find('\0') == std::string_view::npos, "a channel's name has no end within");
  std::vector<std::uint8_t> again = {'L', 'C', '0', '2'};
  again.insert(again.end(), datagram.begin() + 4, datagram.begin() + 8);
  again.insert(again.end(), message.channel.begin(), message.channel.end());
  again.push_back(0);
  again.insert(again.end(), message.data.begin(), message.data.end());
  require(again == datagram, "the parts are the whole");
  return 0;
}
