// SPDX-License-Identifier: MIT
// A datagram of the type MIXLOOP_MESSAGE, for a scene of as many motors as its first byte says.
#include <algorithm>

#include "runtime/bus/wire.hpp"
#include "tests/fuzz/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mixloop;
  using Message = mixloop::MIXLOOP_MESSAGE;
  if (size == 0) return 0;
  const int n = 1 + data[0] % 8;
  const Bytes datagram(data + 1, size - 1);
  peek(datagram);
  Inbox<Message> inbox(n);
  if (inbox.read(datagram)) return 0;
  require(inbox.message.n == n, "an accepted message has the scene's n");
  require(is_finite(inbox.message), "an accepted message is finite");
  Outbox<Message> outbox(n);
  outbox.message = inbox.message;
  require(std::ranges::equal(outbox.encode(), datagram), "an accepted message encodes to the same bytes");
  return 0;
}
