// SPDX-License-Identifier: MIT
// The three processes, started by hand.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <map>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

TEST(Processes, FindEachOtherWhenStartedByHand) {
  Command controller({bin("mixloop-controller"), experiment("paper")});
  Command plant({bin("mixloop-plant"), experiment("paper"), "--json"});
  Command planner({bin("mixloop-planner"), experiment("paper")});
  EXPECT_EQ(plant.wait(), 0) << plant.err();
  EXPECT_EQ(controller.wait(), 0) << controller.err();
  EXPECT_EQ(planner.wait(), 0) << planner.err();
  EXPECT_NEAR(plant.json()["max_position_error"], 13.2066936e-3, 0.5e-10);
}

TEST(Processes, AllocateNothingInTheirSteadyState) {
  if (MIXLOOP_SANITIZED) GTEST_SKIP() << "a sanitizer has its own malloc";
  for (const char* how : {"--lockstep", "--realtime"}) {
    SCOPED_TRACE(how);
    ScratchFolder folder;
    Command command({bin("mixloop"), "run", experiment("paper"), how, "--truth", "--json", "--set",
                     "limits.position_error=1 m"},
                    {"LD_PRELOAD=" MIXLOOP_STEADY_ALLOCATIONS_LIBRARY,
                     "MIXLOOP_STEADY_ALLOCATIONS=" + folder.file("counts")});
    command.wait();  // in real time a busy machine's misses may cost the verdict
    std::ifstream counts(folder.file("counts"));
    std::map<std::string, long> found;
    std::string name;
    for (long count = 0; counts >> name >> count;) found[name] = count;
    EXPECT_EQ(found, (std::map<std::string, long>{
                         {"mixloop-controller", 0}, {"mixloop-planner", 0}, {"mixloop-plant", 0}}))
        << command.err();
  }
}

TEST(Processes, RefuseAPeerThatWasStartedWithSomethingElse) {
  Command controller({bin("mixloop-controller"), experiment("paper"), "--set", "parameters.payload=4 kg"});
  Command planner({bin("mixloop-planner"), experiment("paper")});
  Command plant({bin("mixloop-plant"), experiment("paper"), "--json", "--first-wait", "5"});
  EXPECT_EQ(controller.wait(), 3);
  EXPECT_THAT(controller.err(), HasSubstr("parameters"));
  plant.signal(SIGINT);
  plant.wait();
}

TEST(Processes, StudyAModelMismatchWithoutBeingRefused) {
  Command command({bin("mixloop"), "run", experiment("payload_unknown"), "--json"});
  EXPECT_EQ(command.wait(), 0) << command.err();
}

TEST(Processes, EndWhenTheyHearNobody) {
  Command plant({bin("mixloop-plant"), experiment("paper"), "--json", "--first-wait", "0.3"});
  Command planner(
      {bin("mixloop-planner"), experiment("paper"), "--first-wait", "0.3", "--channel-prefix", "ELSEWHERE_"});
  EXPECT_EQ(plant.wait(), 3);
  EXPECT_EQ(planner.wait(), 3);
  EXPECT_THAT(planner.err(), HasSubstr("ELSEWHERE_STATE"));
}

}  // namespace
}  // namespace mixloop
