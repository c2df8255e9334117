// SPDX-License-Identifier: MIT
#include "tests/web/look.hpp"

namespace mixloop {
namespace {

TEST(ViewPage, FollowsThePlantInABrowserAndAgreesWithTheBus) {
  const ScratchFolder folder;
  RecordProperty("rates", look("view.mjs", {bin("mixloop"), experiment("paper"), folder.path().string()}));
}

// A cart that carries a mast away, twenty times as far as it goes itself.
TEST(ViewPage, StandsUprightAgainstGravityAndFollowsWhatLeavesThePicture) {
  const ScratchFolder folder;
  folder.write("scene.yaml", R"(motors: {u: linear}
coordinates: [x, y]
constraints: {x: u, y: 20*u}
transforms:
  - {from: 0, to: cart, s: x}
  - {from: cart, to: mast, s: y}
bodies: [{frame: cart, mass: 1 kg}]
gravity: [9.81 m/s^2, 0, 0]
end_effector: {frame: cart, axes: [z]}
home: {u: 10 cm}
)");
  const std::string cart =
      folder.write("cart.yaml",
                   "scene: scene.yaml\npath: {line: {from: [10 cm], to: [60 cm]}, duration: 0.5 s}\n"
                   "controller: {law: computed_torque, kp: [1000 N/m], kv: [60 N s/m]}\n");
  Command run({bin("mixloop"), "simulate", cart, "--json", "--out", folder.file("kept")});
  ASSERT_EQ(run.wait(), 0) << run.out() << run.err();
  look("upright.mjs", {bin("mixloop"), folder.file("kept")});
}

}  // namespace
}  // namespace mixloop
