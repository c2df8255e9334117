// SPDX-License-Identifier: MIT
// Experiments that start from another, and their cases.
#include <gmock/gmock.h>

#include "loop/base.hpp"
#include "loop/cases.hpp"
#include "loop/experiment.hpp"
#include "loop/inputs.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SuiteInput : public testing::Test {
 protected:
  nlohmann::json laid(const std::string& name) const {
    return json_of(*on_base(read_document(folder.file(name)), folder.file(name)));
  }
  std::vector<std::string> names(const std::string& text) const {
    std::vector<std::string> result;
    for (const Case& one : cases_of(folder.write("cases.yaml", text))) result.push_back(one.name);
    return result;
  }
  template <class Call>
  InputError refused(const Call& call) const {
    try {
      call();
    } catch (const InputError& error) {
      return error;
    }
    ADD_FAILURE() << "it was taken";
    return {"", {}, ""};
  }

  ScratchFolder folder;
};

TEST_F(SuiteInput, AnExperimentIsLaidOverItsBaseEntryByEntry) {
  folder.write("low.yaml",
               "{rate: 1, plant: {substeps: 2, control: held}, expect: {diverges: no}, seed: 1}\n");
  folder.write("middle.yaml", "{base: low.yaml, seed: 2, faults: [1, 2]}\n");
  folder.write("top.yaml", "{base: middle.yaml, plant: {substeps: 3}, faults: [3], expect: }\n");
  EXPECT_EQ(
      laid("top.yaml"),
      nlohmann::json::parse(
          R"({"rate": "1", "plant": {"substeps": "3", "control": "held"}, "seed": "2", "faults": ["3"]})"));
}

TEST_F(SuiteInput, AScenesPathCountsFromTheFileThatNamesIt) {
  std::filesystem::create_directories(folder.path() / "base/deep");
  folder.write("base/low.yaml", "{scene: deep/robot.yaml, controller: {scene: /other/robot.yaml}}\n");
  folder.write("top.yaml", "{base: base/low.yaml, rate: 1}\n");
  EXPECT_EQ(laid("top.yaml").at("scene"), "base/deep/robot.yaml");
  EXPECT_EQ(laid("top.yaml").at("controller").at("scene"), "/other/robot.yaml");
}

TEST_F(SuiteInput, ABaseThatIsNotThereOrLeadsBackIsRefused) {
  folder.write("alone.yaml", "base: nothing.yaml\n");
  const InputError missing = refused([&] { laid("alone.yaml"); });
  EXPECT_EQ(missing.code, "no_such_file");
  EXPECT_EQ(missing.place.line, 1);
  EXPECT_EQ(missing.place.column, 7);
  folder.write("one.yaml", "base: two.yaml\n");
  folder.write("two.yaml", "base: one.yaml\n");
  EXPECT_EQ(refused([&] { laid("one.yaml"); }).code, "cyclic_definition");
}

TEST_F(SuiteInput, AMistakeInTheBaseHasTheBasesPlace) {
  folder.write("low.yaml", "rate: 1000 Hz\npalnt: {}\n");
  folder.write("top.yaml", "base: low.yaml\n");
  const InputError error = refused(
      [&] { load_experiment(std::filesystem::path(folder.file("top.yaml")), std::vector<Override>()); });
  EXPECT_EQ(error.code, "unknown_key");
  EXPECT_EQ(error.place.file, folder.file("low.yaml"));
  EXPECT_EQ(error.place.line, 2);
}

TEST_F(SuiteInput, CasesAreAllCombinations) {
  EXPECT_THAT(names("cases: {parameters.payload: [0 kg, 2 kg], rate: [1000 Hz, 500 Hz]}\n"),
              ElementsAre("payload=0 kg, rate=1000 Hz", "payload=0 kg, rate=500 Hz",
                          "payload=2 kg, rate=1000 Hz", "payload=2 kg, rate=500 Hz"));
  EXPECT_THAT(names("cases: {path.line.to: {near: [0, 0, 0], far: [1, 1, 1]}, seed: 3}\n"),
              ElementsAre("to=near, seed=3", "to=far, seed=3"));
  EXPECT_THAT(names("rate: 1\n"), ElementsAre());
}

TEST_F(SuiteInput, ACaseSetsWhatItSays) {
  const std::string file =
      folder.write("cases.yaml", "cases: {parameters.payload: [0 kg, 2 kg], path.line.to: [[1, 2, 3]]}\n");
  EXPECT_THAT(case_named(file, "payload=2 kg, to=#1").sets,
              ElementsAre(R"(parameters.payload="2 kg")", R"(path.line.to=["1","2","3"])"));
  const InputError unknown = refused([&] { case_named(file, "payload=3 kg, to=#1"); });
  EXPECT_EQ(unknown.code, "unknown_value");
  EXPECT_THAT(unknown.message, HasSubstr("expected one of: payload=0 kg, to=#1; payload=2 kg, to=#1"));
}

TEST_F(SuiteInput, CasesOfTheSameNameAreRefused) {
  EXPECT_EQ(refused([&] { names("cases: {rate: [1 Hz, 1 Hz]}\n"); }).code, "doubly_defined");
  EXPECT_EQ(refused([&] { names("cases: {rate: []}\n"); }).code, "wrong_size");
  EXPECT_EQ(refused([&] { names("cases: [rate]\n"); }).code, "wrong_kind");
}

}  // namespace
}  // namespace mixloop
