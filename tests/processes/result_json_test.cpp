// SPDX-License-Identifier: MIT
// What travels over the report line and lies in result.json.
#include "processes/result_json.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "processes/summary.hpp"

namespace mixloop {
namespace {

Result whole() {
  Result result{.experiment = "paper", .session = 17, .missing_ticks = 3, .warnings = {{"odd", "numbers"}}};
  result.judged = {Verdict::safe_state, {"it went into its safe state"}, kRunFault};
  result.log = Result::Log{"run.lcmlog", 4000, 1};
  result.error = Result::Error{"lost_peer", "no answer", ""};
  RunFigures& run = result.run.emplace();
  run.measures = {.max_position_error = 1.0 / 3, .rms_position_error = NAN, .ticks = 1000, .safe_at = 0.25};
  run.measures.max_torque = Vector::LinSpaced(3, 0.1, 5);
  run.bounds = {{{"max_torque", 2, 0, 5}, 4.9, true}, {{"rms_position_error", {}, 0.5, 1}, NAN, false}};
  run.integrator = {.name = "dop853", .local_error = 1e-9};
  run.integrator.chosen = {.local_error = 1e-9, .estimate = 3e-10, .why = "the cheapest"};
  run.parameters = {{"payload", 5}};
  run.seed = 18446744073709551615U;
  run.origin = {"1.0", "12", "2.36", "3.4.0", "a processor", "a kernel", 2};
  BusFigures& bus = result.bus.emplace();
  bus.missed_deadlines = 30;
  bus.deadlines = {.longest_miss = 21, .success_last_100 = 0.9, .safe_cause = "commands missed"};
  bus.round_trip = {1e-4, 2e-4, 3e-4, 4e-4};
  bus.wake_up = {1e-5, 2e-5, 3e-5, 4e-5};
  bus.rejected_by_cause = {{"stale", 3}, {"tick", 0}};
  return result;
}

void expect_read_back(const Result& result) {
  const std::string text = json_of(result).dump();
  EXPECT_EQ(json_of(result_in(json_of(result))).dump(), text);
  EXPECT_EQ(json_of(result_in(nlohmann::json::parse(text))).dump(), text);
}

TEST(ResultJson, ReadsBackAsItWasWritten) {
  Result result = whole();
  expect_read_back(result);
  const Result back = result_in(nlohmann::json::parse(json_of(result).dump()));
  EXPECT_EQ(back.judged.verdict, Verdict::safe_state);
  EXPECT_EQ(back.run->bounds[0].expected.motor, 2);
  EXPECT_FALSE(back.run->bounds[1].expected.motor);
  EXPECT_TRUE(std::isnan(back.run->measures.rms_position_error));
  EXPECT_FALSE(back.run->integrator.substeps);
  EXPECT_EQ(back.run->seed, result.run->seed);
}

TEST(ResultJson, LeavesOutWhatThereIsNone) {
  Result result = whole();
  result.bus = {};
  result.session = result.missing_ticks = {};
  result.log = {};
  result.warnings = {};
  result.error = {};
  result.run->measures.safe_at = {};
  result.run->integrator = {.name = "rk4", .substeps = 1};
  result.run->seed = {};
  expect_read_back(result);
  for (const char* key : {"session", "missing_ticks", "log", "warnings", "error", "safe_at", "seed",
                          "missed_deadlines", "overruns", "wake_up_p50"})
    EXPECT_FALSE(json_of(result).contains(key)) << key;
}

TEST(ResultJson, HasNullForWhatWasNeverMeasured) {
  Result result = whole();
  result.run->measures.max_position_error = result.run->measures.max_torque[1] = kNeverMeasured;
  result.bus->round_trip = {};
  const auto json = nlohmann::json::parse(json_of(result).dump());
  EXPECT_TRUE(json["max_position_error"].is_null());
  EXPECT_TRUE(json["max_torque"][1].is_null());
  EXPECT_TRUE(json["bounds"][1]["value"].is_null());
  EXPECT_TRUE(json["round_trip_p50"].is_null());
  expect_read_back(result);
}

TEST(Summary, SaysWhatWasNeverMeasured) {
  Result result = whole();
  result.run->measures = {.max_torque = Vector::Constant(3, kNeverMeasured)};
  result.bus->round_trip = {};
  result.bus->deadlines->success_last_100 = kNeverMeasured;
  const std::string text = summary({.name = "paper"}, result) + bus_summary(result);
  for (const char* line : {"position error   never measured", "max torque       never measured",
                           "round trip       never measured", "no tick was counted"})
    EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
}

TEST(ResultJson, OfWhatDidNotRunSaysWhy) {
  const Result result{.experiment = "odd",
                      .judged = {.verdict = Verdict::fault, .exit_status = kBadInput},
                      .error = {{"unknown_key", "found 'x'", "odd.yaml:3:1"}}};
  EXPECT_EQ(json_of(result).dump(),
            R"({"error":{"code":"unknown_key","message":"found 'x'","where":"odd.yaml:3:1"},)"
            R"("error_status":2,"experiment":"odd"})");
}

TEST(ResultJson, NamesEveryVerdict) {
  for (const Verdict verdict : {Verdict::held, Verdict::missed, Verdict::diverged, Verdict::safe_state,
                                Verdict::interrupted, Verdict::fault}) {
    Result result = whole();
    result.judged.verdict = verdict;
    EXPECT_EQ(result_in(json_of(result)).judged.verdict, verdict) << name_of(verdict);
  }
}

}  // namespace
}  // namespace mixloop
