// SPDX-License-Identifier: MIT
// The filter in the kernel's hands, on a plain socket over loopback.
#include "runtime/bus/channel_filter.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace mixloop {
namespace {

class ChannelFilter : public testing::Test {
 protected:
  ChannelFilter() : receiver_(socket(AF_INET, SOCK_DGRAM, 0)), sender_(socket(AF_INET, SOCK_DGRAM, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(receiver_, reinterpret_cast<sockaddr*>(&to_), sizeof to_);
    socklen_t length = sizeof to_;
    getsockname(receiver_, reinterpret_cast<sockaddr*>(&to_), &length);
  }
  ~ChannelFilter() override {
    close(receiver_);
    close(sender_);
  }

  bool passes(const std::string& datagram) {
    sendto(sender_, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&to_), sizeof to_);
    char byte;
    const bool got = recv(receiver_, &byte, 1, MSG_DONTWAIT) >= 0;  // loopback delivers within sendto
    return got;
  }
  static std::string message(const std::string& channel, const std::string& data = "data") {
    return std::string("LC02\0\0\0\1", 8) + channel + std::string(1, '\0') + data;
  }

  int receiver_, sender_;
  sockaddr_in to_{};
};

TEST_F(ChannelFilter, KeepsSubscribedChannelsOnly) {
  const std::string channels[] = {"MIXLOOP_STATE", "MIXLOOP_STOP", "A", "AB", "ABC", "ABCD"};
  ASSERT_TRUE(attach(receiver_, channel_filter(channels)));
  for (const std::string& channel : channels) {
    EXPECT_TRUE(passes(message(channel))) << channel;
    EXPECT_TRUE(passes(message(channel, ""))) << channel << " without data";
    EXPECT_FALSE(passes(message(channel + "X"))) << channel;
    EXPECT_FALSE(passes(message("X" + channel))) << channel;
    EXPECT_FALSE(passes("LC02....")) << "no channel";
  }
  EXPECT_FALSE(passes(message("MIXLOOP_COMMAND")));
  EXPECT_FALSE(passes(message("MIXLOOP_STATF")));
  EXPECT_FALSE(passes(message("")));
}

TEST_F(ChannelFilter, DropsWhatIsNoShortMessage) {
  const std::string channels[] = {"STATE"};
  ASSERT_TRUE(attach(receiver_, channel_filter(channels)));
  EXPECT_FALSE(passes(""));
  EXPECT_FALSE(passes("LC"));
  std::string fragment = message("STATE");
  fragment[3] = '3';
  EXPECT_FALSE(passes(fragment));
}

}  // namespace
}  // namespace mixloop
