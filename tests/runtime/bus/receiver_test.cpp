// SPDX-License-Identifier: MIT
// Against liblcm's own publisher, and datagrams that no LCM sends.
#include "runtime/bus/receiver.hpp"

#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "runtime/bus/bus.hpp"
#include "runtime/bus/channel_filter.hpp"
#include "tests/runtime/bus/datagram.hpp"

namespace mixloop {
namespace {

const MulticastGroup kGroup = multicast_group(BusOptions{}.url);

const Received* next_within_a_second(Receiver& receiver) {
  pollfd fd{receiver.fd(), POLLIN, 0};
  for (int attempt = 0; attempt < 10; ++attempt) {
    if (const Received* message = receiver.next()) return message;
    poll(&fd, 1, 100);
  }
  return nullptr;
}

/// What liblcm's own receiver hears.
class Liblcm {
 public:
  Liblcm() : lcm_(lcm_create(BusOptions{}.url.c_str())) { lcm_subscribe(lcm_, ".*", take, this); }
  ~Liblcm() { lcm_destroy(lcm_); }
  Liblcm(const Liblcm&) = delete;
  Liblcm& operator=(const Liblcm&) = delete;

  bool next() { return lcm_handle_timeout(lcm_, 1000) > 0; }
  std::string channel;
  std::vector<std::uint8_t> data;

 private:
  static void take(const lcm_recv_buf_t* message, const char* channel, void* context) {
    auto& self = *static_cast<Liblcm*>(context);
    self.channel = channel;
    const auto* bytes = static_cast<const std::uint8_t*>(message->data);
    self.data.assign(bytes, bytes + message->data_size);
  }
  lcm_t* lcm_;
};

// Sizes to LCM's largest short message, names to its longest; 1e6 of them with MIXLOOP_STRESS=full.
TEST(Receiver, HearsWhatLiblcmHearsByteForByte) {
  Liblcm oracle;  // which sends a message of its own at first
  Receiver receiver(kGroup, short_message_filter());
  lcm_t* lcm = lcm_create(BusOptions{}.url.c_str());
  ASSERT_NE(lcm, nullptr);
  std::mt19937_64 random(4);
  constexpr std::size_t kLargestShort = 65'499;  // LCM_SHORT_MESSAGE_MAX_SIZE, the name within
  const char* stress = std::getenv("MIXLOOP_STRESS");
  const int messages = stress != nullptr && std::string(stress) == "full" ? 1'000'000 : 20'000;
  for (int i = 0; i < messages; ++i) {
    std::string channel(1 + random() % 62, 'a');
    for (char& c : channel) c = static_cast<char>('!' + random() % 94);
    const std::size_t most = i % 100 == 0 ? kLargestShort - channel.size() - 1 : 400;
    std::vector<std::uint8_t> data(i % 100 == 1 ? 0 : random() % (most + 1));
    for (auto& byte : data) byte = static_cast<std::uint8_t>(random());
    ASSERT_EQ(lcm_publish(lcm, channel.c_str(), data.data(), static_cast<unsigned>(data.size())), 0);
    const Received* message = next_within_a_second(receiver);
    ASSERT_NE(message, nullptr) << i;
    ASSERT_EQ(message->channel, channel);
    ASSERT_TRUE(std::equal(data.begin(), data.end(), message->data.begin(), message->data.end())) << i;
    ASSERT_TRUE(oracle.next()) << i;
    ASSERT_EQ(oracle.channel, channel);
    ASSERT_EQ(oracle.data, data) << i;
  }
  EXPECT_EQ(receiver.malformed(), 0U);
  EXPECT_EQ(receiver.dropped_by_kernel(), 0U);
  lcm_destroy(lcm);
}

// Two of them would write past liblcm's heap.
TEST(Receiver, CountsWhatItDropsAndHearsOn) {
  Receiver receiver(kGroup, short_message_filter());
  const std::string header("LC02\0\0\0\1", 8);
  std::string fragment("LC03\0\0\0\1\0\0\7\320\377\377\377\300\0\1\0\2", 20);
  fragment.resize(130, 'x');
  for (const std::string& hostile : {std::string(), std::string("LC0"), fragment, fragment})
    send_datagram(hostile);
  send_datagram(header);                          // without a channel
  send_datagram(header + "A");                    // without its end
  send_datagram(header + std::string(500, 'A'));  // longer than a name can be
  send_datagram(header + std::string(64, 'A') + std::string(1, '\0'));
  send_datagram(header + std::string("A\0data", 6));
  const Received* message = next_within_a_second(receiver);
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(message->channel, "A");
  EXPECT_EQ(std::string(message->data.begin(), message->data.end()), "data");
  EXPECT_EQ(receiver.next(), nullptr);
  EXPECT_EQ(receiver.malformed(), 4U);
  EXPECT_EQ(receiver.dropped_by_kernel(), 4U) << "by the filter";
}

TEST(Receiver, TellsWhenTheKernelGotIt) {
  Receiver receiver(kGroup, short_message_filter(), Receiver::Times::of_receipt);
  timespec before{}, after{};
  clock_gettime(CLOCK_REALTIME, &before);
  send_datagram(std::string("LC02\0\0\0\1A\0", 10));
  const Received* message = next_within_a_second(receiver);
  clock_gettime(CLOCK_REALTIME, &after);
  ASSERT_NE(message, nullptr);
  EXPECT_GE(message->at_us, before.tv_sec * 1'000'000 + before.tv_nsec / 1000);
  EXPECT_LE(message->at_us, after.tv_sec * 1'000'000 + after.tv_nsec / 1000 + 1);
}

// What came between the socket's birth and a filter of its own would pass by it.
TEST(Receiver, HearsNothingThatItsFilterDoesntKeep) {
  const std::array<std::string, 1> channels = {"B"};
  Receiver receiver(kGroup, channel_filter(channels));
  send_datagram(std::string("LC02\0\0\0\1A\0no", 12));
  send_datagram(std::string("LC02\0\0\0\1B\0yes", 13));
  const Received* message = next_within_a_second(receiver);
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(message->channel, "B");
  EXPECT_EQ(receiver.dropped_by_kernel(), 1U);
}

}  // namespace
}  // namespace mixloop
