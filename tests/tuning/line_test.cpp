// SPDX-License-Identifier: MIT
// What a line asks for: entries, their ends, bounds; and what it is told where it can't be had.
#include <gmock/gmock.h>

#include "tests/sweep/refused_with.hpp"
#include "tuning/problem.hpp"

namespace mixloop {
namespace {

const std::filesystem::path kPaper = MIXLOOP_EXPERIMENTS "/paper.yaml";

std::vector<Knob> knobs(const std::vector<std::string>& over, const std::vector<Override>& set = {}) {
  const NodePtr document = experiment_document(read_document(kPaper), kPaper, set);
  return read_knobs(over, document, load_scenes(document, kPaper, set));
}

class OfThePaper : public testing::Test {
 protected:
  const Experiment experiment = load_experiment(kPaper, {});
  const Criteria criteria{Columns(experiment, false), experiment};
};

using WhatIsTuned = OfThePaper;
using Bounds = OfThePaper;

TEST_F(WhatIsTuned, AListMeansEachOfItsNumbersFromATenthToTenTimes) {
  const auto found = knobs({"controller.kp,controller.kv[1]"});
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[1].key, "controller.kp[1]");
  EXPECT_EQ(found[1].least, 2.5);
  EXPECT_EQ(found[1].most, 250);
  EXPECT_TRUE(found[1].is_logarithmic());
  EXPECT_EQ(found[1].value(0.5), 25);
  EXPECT_EQ(found[3].key, "controller.kv[1]");
}

TEST_F(WhatIsTuned, HasTheUnitThatStandsInTheFile) {
  const auto found = knobs({"parameters.payload=500 kg..6000 kg", "plant.command_delay=0 us..0.3 ms"},
                           {{"parameters.payload", "5000 kg"}});
  EXPECT_EQ(found[0].text_of(found[0].value(0)), "500 kg");
  EXPECT_FALSE(found[1].is_logarithmic()) << "from 0";
  EXPECT_EQ(found[1].unit, "s");
  EXPECT_EQ(found[1].text_of(found[1].value(1)), "0.0003 s");
  EXPECT_EQ(found[1].text_of(found[1].value(1e-9)), "0 s") << "but for rounding";
  EXPECT_EQ(knobs({"scene.constants.L1=200 mm..0.4 m"})[0].least, 20) << "it stands in cm";
}

TEST_F(WhatIsTuned, ComesBackFromItsShareOfTheWay) {
  for (const Knob& knob : knobs({"controller.kp", "plant.command_delay=0..0.3 ms"}))
    for (const double share : {0.0, 0.123, 0.5, 1.0}) {
      const double value = knob.value(share);
      EXPECT_EQ(knob.value(knob.share(value)), value) << knob.key;
    }
}

TEST_F(WhatIsTuned, ThatCantBeIsRefused) {
  const auto refused = [](const std::string& over, const char* code, const char* message) {
    SCOPED_TRACE(over);
    expect_refused_with(code, message, [&] { knobs({over}); });
  };
  refused("controller.kpp", "unknown_key", "did you mean 'kp'?");
  refused("controller.law", "wrong_kind", "is 'pd_feedforward'; expected a number, or a list of numbers");
  refused("plant.torque_limit", "missing_key", "nothing stands at 'plant.torque_limit'");
  refused("plant.command_delay", "out_of_range", "is 0, of which a tenth and ten times say nothing");
  refused("controller.kp=10", "invalid_range", "expected FROM..TO");
  refused("controller.kp=a..b", "invalid_range", "'a' is no number");
  refused("controller.kp=1000..10", "out_of_range", "an empty range");
  refused("controller.kp=200..300", "out_of_range", "'controller.kp[0]' is 100, outside of 200..300");
  refused("parameters.payload=1 m..2 m", "wrong_dimension", "expected a mass");
  refused("expect.max_position_error", "invalid_path", "changes no run");
  refused("", "missing_key", "no key");
  expect_refused_with("missing_key", "nothing is tuned", [] { knobs({}); });
}

TEST_F(Bounds, AreInTheUnitsThatStandThere) {
  const auto torques = read_bounds("max_torque < 5 N m", criteria);
  ASSERT_EQ(torques.size(), 3U);
  EXPECT_EQ(criteria[torques[2].criterion].name, "max_torque[2]");
  EXPECT_EQ(torques[2].limit, 5);
  EXPECT_TRUE(torques[2].is_upper && torques[2].is_strict);
  EXPECT_FALSE(torques[2].holds(5));
  const auto each = read_bounds("max_torque<=[2, 500 N cm, 3] N m", criteria);
  EXPECT_EQ(each[1].limit, 5);
  EXPECT_TRUE(each[1].holds(5));
  EXPECT_EQ(read_bounds("max_torque[1] <= 2 N m", criteria).size(), 1U);
  const auto delay = read_bounds("longest_delay >= 0.3 ms", criteria);
  EXPECT_DOUBLE_EQ(delay[0].limit, 0.3e-3);
  EXPECT_TRUE(delay[0].holds(0.4e-3) && !delay[0].holds(0.2e-3));
  EXPECT_EQ(read_bounds("gain_margin > 1.2", criteria)[0].criterion,
            read_bounds("gain_margin.most > 1.2", criteria)[0].criterion);
}

TEST_F(Bounds, MayBeWhatIsNow) {
  EXPECT_EQ(read_bounds("longest_delay >= now", criteria)[0].times_now, 1);
  EXPECT_EQ(read_bounds("max_torque <= 0.9 now", criteria)[1].times_now, 0.9);
  EXPECT_FALSE(read_bounds("longest_delay >= 1 ms", criteria)[0].times_now);
}

TEST_F(Bounds, ThatCantBeAreRefused) {
  const auto refused = [&](const std::string& subject, const char* code, const char* message) {
    SCOPED_TRACE(subject);
    expect_refused_with(code, message, [&] { read_bounds(subject, criteria); });
  };
  refused("longest_dela > 1 ms", "unknown_value", "did you mean 'longest_delay'?");
  refused("max_torque[7] < 1 N m", "unknown_value", "isn't measured of this experiment");
  refused("energy_drift < 1", "unknown_value", "isn't measured of this experiment");
  refused("max_torque 5 N m", "invalid_range", "no '<' or '>'");
  refused("max_torque <", "invalid_range", "nothing stands behind its sign");
  refused("max_torque < 5 m", "wrong_dimension", "max_torque[0]");
  refused("max_torque < [1, 2]", "wrong_size", "2 bounds for 3 numbers");
  refused("max_torque < [1, 2, 3", "invalid_range", "lacks its ']'");
  refused("max_torque < 5 Nn", "unknown_unit", "Nn");
  expect_refused_with("unknown_value", "did you mean 'max_position_error'?",
                      [&] { read_goal("max_position_eror", false, criteria); });
  expect_refused_with("missing_key", "expected --minimise NAME", [&] { read_goal("", false, criteria); });
}

TEST_F(Bounds, OfANumberThatMayBeNoOtherOneAreRefused) {
  TuneRequest request{.over = {"plant.substeps=1..4"}, .goal = "max_position_error"};
  request.sweep.experiment = kPaper;
  expect_refused_with("out_of_range", "'plant.substeps' can't be tuned",
                      [&] { Problem(request, 1, [] { return true; }); });
  request.over = {"controller.kp"};
  request.sweep.design.sampled = {parse_sampled("controller.kp[0]=uniform(1, 2)")};
  expect_refused_with("doubly_defined", "varied already", [&] { Problem(request, 1, [] { return true; }); });
}

}  // namespace
}  // namespace mixloop
