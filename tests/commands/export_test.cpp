// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;

/// A CSV file: its header, and its cells as text, by column.
struct Table {
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> columns;
  std::size_t rows = 0;
};

Table table_in(const std::string& file) {
  Table table;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line); table.rows += 1) {
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column)
      if (table.rows == 0)
        table.names.push_back(cell);
      else
        table.columns[table.names.at(column)].push_back(cell);
  }
  table.rows -= 1;
  return table;
}

std::string big_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> 8 * i);
  return text;
}

/// An event as LCM logs it.
std::string event(const std::string& channel, const std::string& data) {
  return "\xED\xA1\xDA\x01" + big_endian(0, 8) + big_endian(1, 8) + big_endian(channel.size(), 4) +
         big_endian(data.size(), 4) + channel + data;
}

/// One run, logged by itself and by lcm-logger, for all tests.
class Export : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    kept = std::make_unique<ScratchFolder>();
    const std::string logged = kept->file("logger.lcmlog");
    Command logger({"/usr/bin/lcm-logger", "--lcm-url=udpm://239.255.76.67:7667?ttl=0", logged});
    // It listens when it has a socket on LCM's port, 7667.
    ASSERT_TRUE(eventually([] { return bytes_of("/proc/net/udp").find(":1DF3 ") != std::string::npos; }));
    Command run({bin("mixloop"), "run", experiment("paper"), "--truth", "--out", kept->path().string()});
    ASSERT_EQ(run.wait(), 0) << run.err();
    // lcm-logger writes as it likes; what it has is on disk after an ordered stop.
    logger.signal(SIGINT);
    logger.wait();
  }
  static void TearDownTestSuite() { kept.reset(); }

  static std::string own_log() { return kept->file("run.lcmlog"); }
  static std::string loggers() { return kept->file("logger.lcmlog"); }

  static std::unique_ptr<ScratchFolder> kept;
  ScratchFolder folder;
};
std::unique_ptr<ScratchFolder> Export::kept;

TEST_F(Export, GivesTheRunsNumbersToTheLastDigit) {
  const Table trajectory = table_in(kept->file("trajectory.csv"));
  std::map<double, std::size_t> row_at;
  for (std::size_t row = 0; row < trajectory.rows; ++row)
    row_at[std::stod(trajectory.columns.at("t")[row])] = row;
  for (const std::string& log : {own_log(), loggers()}) {
    SCOPED_TRACE(log);
    Command exported({bin("mixloop"), "export", log, "--out", folder.path().string()});
    ASSERT_EQ(exported.wait(), 0) << exported.err();
    for (const auto& [channel, pairs] : std::map<std::string, std::map<std::string, std::string>>{
             {"STATE", {{"psi_measured_", "psi_"}, {"psid_measured_", "psid_"}}},
             {"COMMAND", {{"tau_commanded_", "tau_"}}},
             {"TRUTH", {{"tau_applied_", "tau_applied_"}}}}) {
      SCOPED_TRACE(channel);
      const Table table = table_in(folder.file("MIXLOOP_" + channel + ".csv"));
      // A log has gaps: a busy machine loses some. Without any of it nothing would be compared.
      ASSERT_GT(table.rows, 100);
      for (const auto& [logged, kept_as] : pairs)
        for (const char motor : {'1', '2', '3'})
          for (std::size_t row = 0; row < table.rows; ++row) {
            const double t = std::stod(table.columns.at("seq")[row]) / 1000;
            ASSERT_EQ(table.columns.at(logged + motor)[row],
                      trajectory.columns.at(kept_as + motor)[row_at.at(t)])
                << logged << motor << " at " << t;
          }
    }
  }
}

TEST_F(Export, SaysWhatEachColumnIs) {
  Command exported({bin("mixloop"), "export", own_log(), "--out", folder.path().string(), "--json"});
  ASSERT_EQ(exported.wait(), 0) << exported.err();
  const auto result = exported.json();
  std::vector<std::string> described;
  std::istringstream lines(bytes_of(folder.file("columns.csv")));
  for (std::string line; std::getline(lines, line);) described.push_back(line);
  EXPECT_THAT(described,
              IsSupersetOf({std::string("MIXLOOP_STATE.csv,psid_measured_3,\"rad/s or m/s, their rates\""),
                            std::string("MIXLOOP_TRUTH.csv,acceleration_z,\"m/s^2, in frame 0\""),
                            std::string("MIXLOOP_TRUTH.csv,kinetic_energy,\"J\"")}));
  std::size_t columns = 1;
  for (const auto& file : result["files"]) {
    const Table table = table_in(folder.file(file["file"]));
    EXPECT_EQ(file["rows"], table.rows);
    EXPECT_EQ(file["undecodable"], 0);
    columns += table.names.size();
  }
  EXPECT_EQ(described.size(), columns);
  EXPECT_THAT(
      table_in(folder.file("MIXLOOP_SIM_CONTROL.csv")).names,
      ElementsAre("received_us", "n", "utime", "seq", "session", "config", "action", "reason", "speed"));
}

TEST_F(Export, SaysWhatIsNotOursAndWhatIsCutOff) {
  const std::string own = bytes_of(own_log());
  const std::string log = folder.write("log", event("A/B", "of a stranger") + own.substr(0, own.size() - 3));
  Command exported({bin("mixloop"), "export", log});
  ASSERT_EQ(exported.wait(), 0) << exported.err();
  EXPECT_THAT(exported.err(), AllOf(HasSubstr("cut off"), HasSubstr("not of mixloop's types: A/B")));
  EXPECT_THAT(exported.out(), HasSubstr(log + ".csv/MIXLOOP_STATE.csv"));

  // A channel whose n changes, or that has another type's messages, keeps to its first.
  std::string other = own;
  for (std::size_t at = 0; (at = other.find("MIXLOOP_STATE", at)) != std::string::npos; at += 13)
    other.replace(at, 13, "MIXLOOP_TRUTH");
  Command mixed({bin("mixloop"), "export", folder.write("mixed", other), "--json"});
  ASSERT_EQ(mixed.wait(), 0) << mixed.err();
  const auto files = mixed.json()["files"];
  const auto truth = std::find_if(files.begin(), files.end(),
                                  [](const auto& file) { return file["channel"] == "MIXLOOP_TRUTH"; });
  ASSERT_NE(truth, files.end());
  EXPECT_EQ((*truth)["type"], "state_t");
  EXPECT_GT((*truth)["undecodable"], 100);
  EXPECT_EQ(table_in(folder.file("mixed.csv/MIXLOOP_TRUTH.csv")).rows, (*truth)["rows"]);
}

TEST_F(Export, RefusesWhatHasNothingToExport) {
  const auto refused = [&](const std::string& log, const std::string& code) {
    SCOPED_TRACE(log);
    Command exported({bin("mixloop"), "export", log, "--json", "--out", folder.file("out")});
    EXPECT_EQ(exported.wait(), 2);
    EXPECT_EQ(exported.json()["error"]["code"], code);
    EXPECT_EQ(exported.json()["error"]["where"], log);
  };
  refused(folder.file("none"), "cannot_read");
  refused(folder.write("text", "t,psi\n1,2\n"), "not_a_log");
  refused(folder.write("empty", ""), "empty_log");
  refused(folder.write("foreign", event("POSE", std::string(80, 'x')) + event("SCAN", "")), "no_messages");
  // A claim of a billion motors is not believed.
  const std::string own = bytes_of(own_log());
  std::string greedy = own.substr(0, own.find("\xED\xA1\xDA\x01", 4));
  greedy.replace(greedy.find("MIXLOOP_") + greedy[23] + 8, 4, "\x3F\xFF\xFF\xFF");
  refused(folder.write("greedy", greedy), "no_messages");
  EXPECT_TRUE(!std::filesystem::exists(folder.file("out")) || std::filesystem::is_empty(folder.file("out")))
      << "half files are left";
}

TEST_F(Export, LeavesNoHalfFilesWhenInterrupted) {
  const std::string own = bytes_of(own_log());
  {
    std::ofstream log(folder.file("long"), std::ios::binary);
    for (int i = 0; i < 150; ++i) log << own;  // some seconds of work
  }
  const std::string out = folder.file("out");
  Command exported({bin("mixloop"), "export", folder.file("long"), "--out", out});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(out + "/MIXLOOP_STATE.csv.part"); }));
  EXPECT_FALSE(std::filesystem::exists(out + "/MIXLOOP_STATE.csv"));
  exported.signal(SIGINT);
  EXPECT_EQ(exported.wait(), 130);
  EXPECT_TRUE(std::filesystem::is_empty(out));
  EXPECT_THAT(exported.err(), HasSubstr("interrupted"));
}

}  // namespace
}  // namespace mixloop
