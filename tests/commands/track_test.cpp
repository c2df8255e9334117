// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "tests/support/command.hpp"
#include "tests/support/heard.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

TEST(Track, ExitsWithTheHighestStatusAndWritesJunit) {
  ScratchFolder folder;
  Command command({bin("mixloop"), "track", experiment("paper"), experiment("nothing"),
                   experiment("must_diverge"), "--json", "--junit", folder.file("track.xml")});
  EXPECT_EQ(command.wait(), 2);
  const auto results = command.json()["results"];
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0]["verdict"], "held");
  EXPECT_EQ(results[1]["error"]["code"], "no_such_file");
  EXPECT_EQ(results[2]["verdict"], "held");  // it diverges, as expected
  EXPECT_THAT(bytes_of(folder.file("track.xml")),
              testing::HasSubstr("tests=\"3\" failures=\"0\" errors=\"1\""));
}

TEST(Track, SaysWhichBoundWasMissed) {
  Command command({bin("mixloop"), "track", experiment("paper"), "--set", "expect.max_position_error=13 mm"});
  EXPECT_EQ(command.wait(), 1);
  EXPECT_THAT(command.out(), testing::HasSubstr("max_position_error is 13.2067 mm; expected at most 13 mm"));
}

TEST(Track, GivesTheSameOverTheBus) {
  std::vector<std::string> hashes;
  for (const char* route : {"--patience=10", "--over-bus"}) {
    Command command({bin("mixloop"), "track", experiment("paper"), experiment("via_points"),
                     experiment("move_to_start"), "--json", route});
    ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
    std::string all;
    const auto json = command.json();
    for (const auto& result : json["results"]) all += result["trajectory_sha256"].get<std::string>();
    hashes.push_back(all);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Track, JudgesProcessesThatAreAlreadyRunning) {
  Command listener({bin("mixloop"), "track", experiment("paper"), "--attach", "--json"});
  ASSERT_TRUE(eventually([] { return listeners() == 1; }));
  // Slowly: a listener whose core is away for 50 ms must not lose a message.
  Command run({bin("mixloop"), "run", experiment("paper"), "--speed", "0.3", "--json"});
  ASSERT_EQ(run.wait(), 0) << run.err();
  ASSERT_EQ(listener.wait(), 0) << listener.out() << listener.err();
  const auto heard = listener.json()["results"][0];
  EXPECT_EQ(heard["missing_ticks"], 0);
  EXPECT_EQ(heard["trajectory_sha256"], run.json()["trajectory_sha256"]);
}

TEST(Track, SaysThatNoPlantIsHeard) {
  Command command({bin("mixloop"), "track", experiment("paper"), "--attach", "--patience", "0.3", "--json"});
  EXPECT_EQ(command.wait(), 3);
  EXPECT_EQ(command.json()["results"][0]["error"]["code"], "lost_peer");
}

}  // namespace
}  // namespace mixloop
