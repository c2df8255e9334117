// SPDX-License-Identifier: MIT
// Keys of what is varied are entries that there are, or may be.
#include <gmock/gmock.h>

#include "sweep/sweep.hpp"
#include "tests/sweep/refused_with.hpp"

namespace mixloop {
namespace {

SweepRequest varied(const std::string& text) {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.design.varied = {parse_varied(text)};
  return request;
}

Sweep keyed(const SweepRequest& request) { return Sweep("test", request, Evaluation::interpreter, false); }

TEST(SweepKeys, WhatIsNoEntryIsRefusedWithTheNearestOne) {
  const auto refused = [](const char* text, const char* code, const char* message) {
    SCOPED_TRACE(text);
    expect_refused_with(code, message, [&] { keyed(varied(text)); });
  };
  refused("controler.kp=1,2", "unknown_key",
          "--vary controler.kp: the experiment has no key 'controler'; did you mean 'controller'?");
  refused("controller.kpp=1,2", "unknown_key", "did you mean 'kp'?");
  refused("parameters.paylod=1,2", "unknown_key", "did you mean 'payload'?");
  refused("plant.parameters.paylod=1,2", "unknown_key", "did you mean 'payload'?");
  refused("scene.constants.L9=1,2", "unknown_key", "'constants' has no entry 'L9'");
  refused("scene.gravty=1,2", "unknown_key", "did you mean 'gravity'?");
  refused("scene.bodies[0].mas=1,2", "unknown_key", "did you mean 'mass'?");
  refused("faults[0].at=1,2", "invalid_path", "'faults' has no item [0]: it is not there");
  refused("controller.kp[3]=1,2", "invalid_path", "it is a list of 3");
  refused("controller.kp.0=1,2", "invalid_path", "e.g. [0]");
  refused("rate.x=1,2", "invalid_path", "'rate' is a single value");
  refused("expect.max_position_error=1,2", "invalid_path", "changes no run");
  refused("parameters.payload=1 m,2 m", "wrong_dimension", "expected a mass (kg); so it is in all of");
}

TEST(SweepKeys, EntriesThatTheFileLacksMayBeVariedWhereTheyMayStand) {
  for (const char* text :
       {"plant.command_delay=0,0.1 ms", "plant.torque_limit=[2,5,3],[3,6,4]", "seed=1,2",
        "plant.parameters.payload=1,2 kg", "scene.constants.L1=30,31 cm", "plant.control=held",
        "scene.bodies[6].mass=1,2 kg", "path.line.to[0]=-0.3,-0.2"}) {
    SCOPED_TRACE(text);
    EXPECT_NO_THROW(keyed(varied(text)));
  }
}

TEST(SweepKeys, FaultsTimesAndKindsAreEntries) {
  SweepRequest request = varied("faults[0].at=0.2 s..0.4 s:3");
  request.overrides = {{"faults", "[{at: 0.3 s, motor: psi2, kind: 'off', for: 0.1 s}]"}};
  request.design.varied.push_back(parse_varied("faults[0].kind=off,stuck"));
  const Sweep sweep = keyed(request);
  const PreparedRun run = sweep.setup().prepared(3);
  ASSERT_EQ(run.experiment.plant.faults.scheduled.size(), 1U);
  EXPECT_EQ(run.experiment.plant.faults.scheduled[0].at, 0.3);
  EXPECT_EQ(run.experiment.plant.faults.scheduled[0].kind, Fault::Kind::stuck);
}

}  // namespace
}  // namespace mixloop
