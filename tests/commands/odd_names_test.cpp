// SPDX-License-Identifier: MIT
// Names of files may be any bytes: what is said of them is text all the same, for JSON, XML and terminals.
#include <gmock/gmock.h>

#include "notation/utf8.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// No UTF-8, an order to the terminal, and what XML forbids.
const std::string kOdd = "odd\xff\x1b[31m\x01\n\"<", kShown = "odd\\xff\\x1b[31m\\x01\\x0a\"<";

struct OddNames : testing::Test {
  void SetUp() override {
    std::string text = bytes_of(experiment("paper"));
    const std::string scene = "../scenes/mixed_loop_robot.yaml";
    text.replace(text.find(scene), scene.size(), robot());
    odd = folder.write(kOdd + ".yaml", text);
  }
  static void expect_text(const Command& command) {
    EXPECT_FALSE(first_non_text(command.out())) << command.out();
    EXPECT_FALSE(first_non_text(command.err())) << command.err();
  }

  ScratchFolder folder;
  std::string odd;
};

TEST_F(OddNames, OfAnExperimentAndItsFolder) {
  const std::string out = folder.file(kOdd + " kept");
  Command command({bin("mixloop"), "simulate", odd, "--out", out});
  ASSERT_EQ(command.wait(), 0) << command.err();
  expect_text(command);
  EXPECT_THAT(command.out(),
              AllOf(HasSubstr(kShown + ": held"), HasSubstr("kept in " + folder.file(kShown))));
  for (const char* name : {"/result.json", "/inputs.json"})
    EXPECT_TRUE(nlohmann::json::accept(bytes_of(out + name))) << name;
  Command as_json({bin("mixloop"), "simulate", odd, "--json"});
  ASSERT_EQ(as_json.wait(), 0) << as_json.err();
  EXPECT_EQ(as_json.json()["experiment"], kShown);
}

TEST_F(OddNames, OfARunOverTheBus) {
  Command command({bin("mixloop"), "run", odd, "--json", "--out", folder.file(kOdd + " run")});
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  expect_text(command);
  EXPECT_EQ(command.json()["experiment"], kShown);
}

TEST_F(OddNames, InAJUnitReport) {
  const std::string bad = folder.write(kOdd + " bad.yaml", "scene: [");
  Command command(
      {bin("mixloop"), "track", odd, bad, folder.file(kOdd + " missing"), "--junit", folder.file("xml")});
  EXPECT_EQ(command.wait(), 2) << command.err();
  expect_text(command);
  const std::string junit = bytes_of(folder.file("xml"));
  EXPECT_FALSE(first_non_text(junit)) << junit;
  EXPECT_THAT(junit, AllOf(HasSubstr("tests=\"3\" failures=\"0\" errors=\"2\""),
                           HasSubstr("name=\"odd\\xff\\x1b[31m\\x01\\x0a&quot;&lt;\"")));
  Command as_json({bin("mixloop"), "track", odd, bad, "--json"});
  EXPECT_EQ(as_json.wait(), 2);
  EXPECT_THAT(as_json.json()["results"][1]["error"]["where"].get<std::string>(), HasSubstr(kShown));
}

TEST_F(OddNames, InErrorsOfEveryCommand) {
  const std::string missing = folder.file(kOdd);
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"simulate", missing},
                                             {"run", missing},
                                             {"run", missing, "--json"},
                                             {"explain", missing},
                                             {"explain", missing, "--json"},
                                             {"report", missing},
                                             {"replay", missing, missing},
                                             {"export", missing},
                                             {"stability", missing},
                                             {"simulate", odd, "--" + kOdd},
                                             {"simulate", odd, "--ages", missing},
                                             {"simulate", odd, "--set", kOdd},
                                             {"simulate", odd, "--evaluation", kOdd},
                                             {"run", odd, "--channel-prefix", kOdd},
                                             {kOdd}}) {
    SCOPED_TRACE(printable_name(words[0] + " " + words.back()));
    std::vector<std::string> line = words;
    line.insert(line.begin(), bin("mixloop"));
    Command command(line);
    EXPECT_EQ(command.wait(), 2) << command.out() << command.err();
    expect_text(command);
    EXPECT_THAT(command.out() + command.err(), HasSubstr("\\x1b[31m"));
    EXPECT_TRUE(words.back() != "--json" || nlohmann::json::accept(command.out())) << command.out();
  }
}

}  // namespace
}  // namespace mixloop
