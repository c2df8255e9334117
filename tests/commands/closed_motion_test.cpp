// SPDX-License-Identifier: MIT
// Motions of mechanisms whose chains close, over the bus: the same bytes, on a bad network too.
#include <gmock/gmock.h>

#include "tests/support/bad_network.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

struct Motion {
  const char* name;
  std::vector<std::string> shorter;  ///< what makes it short enough
};

nlohmann::json result_of(const Motion& motion, const char* by,
                         const std::vector<std::string>& environment = {}) {
  std::vector<std::string> words = {bin("mixloop"), by, experiment(motion.name), "--json"};
  for (const auto& entry : motion.shorter) words.insert(words.end(), {"--set", entry});
  Command command(words, environment);
  EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
  return command.json();
}

TEST(ClosedMotion, HasTheSameBytesOnABadNetwork) {
  int seed = 0;
  for (const Motion& motion :
       {Motion{"four_bar_turns", {"duration=0.5 s", "expect={}"}}, Motion{"four_bar_path", {"path.repeat=1"}},
        Motion{"slider_crank_closed", {"duration=0.5 s", "expect={}"}},
        Motion{"double_four_bar_closed", {"duration=0.5 s", "expect={}"}}, Motion{"seven_bodies", {}},
        Motion{"planar_3rrr_swing", {"duration=0.3 s", "expect={}"}}, Motion{"delta_circle", {}},
        Motion{"spatial_five_bar_swing", {"duration=0.5 s", "expect={}"}},
        Motion{"four_bar_chain_swing", {"duration=0.3 s", "expect={}"}},
        Motion{"four_bar_rocker_turns", {"duration=0.8 s", "expect={}"}}}) {
    SCOPED_TRACE(motion.name);
    const auto alone = result_of(motion, "simulate");
    const auto lossy = result_of(motion, "run", bad_network(++seed));
    EXPECT_EQ(lossy["trajectory_sha256"], alone["trajectory_sha256"]);
    for (const char* measure :
         {"closure_residual", "closure_condition", "switches", "final_psi", "energy_drift"})
      EXPECT_EQ(lossy.value(measure, nlohmann::json()), alone.value(measure, nlohmann::json())) << measure;
    EXPECT_GT(lossy["resent"], 0);
  }
}

// The motors' coordinates, which messages have, don't say where the others are.
TEST(ClosedMotion, ThatSwitchesCoordinatesIsNotDrawn) {
  Command view({bin("mixloop"), "view", experiment("four_bar_rocker_turns"), "--json", "--port", "0"});
  EXPECT_EQ(view.wait(), 2);
  EXPECT_EQ(view.json()["error"]["code"], "switched_coordinates");
}

}  // namespace
}  // namespace mixloop
