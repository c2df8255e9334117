// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kExamine = {bin("mixloop"), "doctor", "--json", "--seconds", "0.2"};

nlohmann::json finding(const nlohmann::json& report, const std::string& what) {
  for (const auto& one : report["findings"])
    if (one["what"].get<std::string>().starts_with(what)) return one;
  ADD_FAILURE() << "no finding on " << what << " in " << report.dump(1);
  return {};
}

// How fit the machine is, is not this test's: what is found is.
TEST(Doctor, LooksAtAllThatOneKilohertzNeeds) {
  Command command(kExamine);
  const int status = command.wait();
  const auto report = command.json();
  EXPECT_EQ(status, report["fit"].get<bool>() ? 0 : 1);
  EXPECT_EQ(report["findings"].size(), 9U);
  EXPECT_EQ(finding(report, "multicast route")["verdict"], "good");
  EXPECT_THAT(finding(report, "wake-up")["value"], HasSubstr("p99"));
  EXPECT_THAT(finding(report, "LCM round trip")["value"], HasSubstr("p99"));
  EXPECT_EQ(finding(report, "other publishers")["verdict"], "good");
  for (const auto& one : report["findings"])
    EXPECT_EQ(one["verdict"] == "good", one["mend"] == "") << one.dump(1);
}

TEST(Doctor, NamesWhoElseIsOnTheBus) {
  Command run({bin("mixloop"), "run", experiment("paper"), "--hold", "--speed", "1"});
  ASSERT_TRUE(eventually([&] { return run.out().find("Holding") != std::string::npos; }));
  Command command(kExamine);
  command.wait();
  const auto others = finding(command.json(), "other publishers");
  EXPECT_EQ(others["verdict"], "fair");
  EXPECT_THAT(others["value"], HasSubstr("on MIXLOOP_STATE"));
  EXPECT_THAT(others["mend"], HasSubstr("--channel-prefix"));
  run.signal(SIGINT);
  run.wait();
}

TEST(Doctor, SaysHowToMendAMissingRoute) {
  std::vector<std::string> words = {"/usr/bin/unshare", "-rn"};
  words.insert(words.end(), kExamine.begin(), kExamine.end());
  Command command(words);
  EXPECT_EQ(command.wait(), 1) << command.err();
  const auto route = finding(command.json(), "multicast route");
  EXPECT_EQ(route["verdict"], "bad");
  EXPECT_THAT(route["mend"], HasSubstr("ip route add 224.0.0.0/4 dev lo"));
  EXPECT_EQ(finding(command.json(), "LCM round trip")["verdict"], "bad");
}

}  // namespace
}  // namespace mixloop
