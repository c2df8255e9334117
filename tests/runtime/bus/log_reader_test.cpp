// SPDX-License-Identifier: MIT
#include "runtime/bus/log_reader.hpp"

#include <gmock/gmock.h>
#include <lcm/eventlog.h>

#include <fstream>
#include <random>

#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct Logged {
  std::int64_t received_us = 0;
  std::string channel, data;
  bool operator==(const Logged&) const = default;
  friend std::ostream& operator<<(std::ostream& out, const Logged& event) {
    return out << event.received_us << " " << event.channel << " " << event.data.size() << " bytes";
  }
};

/// Written by LCM's own writer, as lcm-logger does.
void write_log(const std::string& file, const std::vector<Logged>& events, const char* mode = "w") {
  lcm_eventlog_t* log = lcm_eventlog_create(file.c_str(), mode);
  for (const Logged& logged : events) {
    lcm_eventlog_event_t event{};
    event.timestamp = logged.received_us;
    event.channellen = static_cast<std::int32_t>(logged.channel.size());
    event.channel = const_cast<char*>(logged.channel.c_str());
    event.datalen = static_cast<std::int32_t>(logged.data.size());
    event.data = const_cast<char*>(logged.data.data());
    lcm_eventlog_write_event(log, &event);
  }
  lcm_eventlog_destroy(log);
}

std::vector<Logged> all_of(LogReader& log) {
  std::vector<Logged> events;
  while (const LogEvent* event = log.next())
    events.push_back({event->received_us,
                      std::string(event->channel),
                      {reinterpret_cast<const char*>(event->data.data()), event->data.size()}});
  EXPECT_EQ(log.next(), nullptr) << "an end stays an end";
  return events;
}

/// Lengths that make blocks of the reader end at every place in an event, the magic inside of data too.
std::vector<Logged> seeded_events(int count, std::size_t longest) {
  std::mt19937 random(7);
  std::vector<Logged> events;
  for (int i = 0; i < count; ++i) {
    std::string data(random() % longest, '\0');
    for (char& c : data) c = static_cast<char>(random());
    if (i % 5 == 0) data += "\xED\xA1\xDA\x01 is how an event begins";
    events.push_back({1'000'000 + i, "CHANNEL_" + std::to_string(i % 3), data});
  }
  return events;
}

TEST(LogReader, GivesEveryEventThatLcmWrote) {
  const ScratchFolder folder;
  const auto events = seeded_events(4000, 2000);  // about four of the reader's blocks
  write_log(folder.file("log"), events);
  LogReader log(folder.file("log"));
  EXPECT_EQ(all_of(log), events);
  EXPECT_EQ(log.position(), log.size());
  EXPECT_THAT(log.damage(), IsEmpty());
}

// The bytes are there, as holes of the file: what is claimed could be had.
TEST(LogReader, TakesNoMemoryForAnEventThatClaimsMoreThanOneMayHave) {
  const ScratchFolder folder;
  const std::string file = folder.file("log");
  std::ofstream(file) << std::string("\xED\xA1\xDA\x01", 4) << std::string(16, '\0')
                      << std::string("\0\0\0\x01\x12\0\0\0X", 9);  // a channel, X, and 0x12000000 bytes
  write_log(folder.file("whole"), {{7, "Y", "data"}});
  std::filesystem::resize_file(file, 0x12000000 + 29);
  std::ofstream(file, std::ios::app | std::ios::binary) << bytes_of(folder.file("whole"));
  LogReader log(file);
  EXPECT_EQ(all_of(log), (std::vector<Logged>{{7, "Y", "data"}}));
  EXPECT_THAT(log.damage(),
              HasSubstr("the event at byte 0 claims 301989888 bytes of data, more than the 268435456"));
}

TEST(LogReader, GivesEventsLongerThanItsBlock) {
  const ScratchFolder folder;
  const auto events = seeded_events(4, 5'000'000);
  write_log(folder.file("log"), events);
  LogReader log(folder.file("log"));
  EXPECT_EQ(all_of(log), events);
}

TEST(LogReader, SaysWhereALogIsCutOff) {
  const ScratchFolder folder;
  const std::vector<Logged> events = {{1, "A", "first"}, {2, "B", "second"}};
  write_log(folder.file("whole"), events);
  const std::string whole = bytes_of(folder.file("whole"));
  const std::size_t first = 28 + 1 + 5;  // header, channel, data
  for (std::size_t length = 4; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    LogReader log(folder.write("cut", whole.substr(0, length)));
    EXPECT_EQ(all_of(log).size(), length < first ? 0 : 1);
    EXPECT_EQ(log.cut_off_bytes(), length < first ? length : length - first);
    EXPECT_EQ(log.damage().empty(), length == first);
    EXPECT_EQ(log.skipped_bytes(), 0);
  }
}

TEST(LogReader, GoesOnWhereALoggerAppendedToACutOffLog) {
  const ScratchFolder folder;
  const auto before = seeded_events(50, 300), after = seeded_events(20, 400);
  write_log(folder.file("log"), before);
  const auto whole = std::filesystem::file_size(folder.file("log"));
  std::filesystem::resize_file(folder.file("log"), whole - 10);
  write_log(folder.file("log"), after, "a");
  LogReader log(folder.file("log"));
  auto expected = before;
  const std::size_t lost = 28 + before.back().channel.size() + before.back().data.size() - 10;
  expected.pop_back();
  expected.insert(expected.end(), after.begin(), after.end());
  EXPECT_EQ(all_of(log), expected);
  EXPECT_EQ(log.skipped_bytes(), static_cast<std::int64_t>(lost));
  EXPECT_EQ(log.cut_off_bytes(), 0);
  EXPECT_THAT(log.damage(), HasSubstr(std::to_string(whole - 10 - lost)));
}

TEST(LogReader, TakesNoLengthAtItsWord) {
  const ScratchFolder folder;
  write_log(folder.file("log"), {{1, "A", "first"}, {2, "B", "second"}, {3, "C", "third"}});
  const std::string sound = bytes_of(folder.file("log"));
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    std::string text = sound;
    for (std::size_t changed = 1 + random() % 3; changed > 0; --changed)
      text[4 + random() % (text.size() - 4)] = static_cast<char>(random());
    SCOPED_TRACE(i);
    LogReader log(folder.write("changed", text));
    std::size_t bytes = 0;
    for (const Logged& event : all_of(log)) bytes += 28 + event.channel.size() + event.data.size();
    EXPECT_EQ(bytes + static_cast<std::size_t>(log.skipped_bytes() + log.cut_off_bytes()), text.size());
  }
}

TEST(LogReader, RefusesWhatIsNoLog) {
  const ScratchFolder folder;
  const auto refused = [](const std::string& file, const std::string& code, const std::string& part) {
    const auto error = input_error([&] { LogReader{file}; });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, code);
    EXPECT_EQ(error->place.file, file);
    EXPECT_THAT(error->message, HasSubstr(part));
  };
  refused(folder.file("none"), "cannot_read", "no such file");
  refused(folder.path().string(), "cannot_read", "no file");
  refused(folder.write("empty", ""), "empty_log", "is empty");
  refused(folder.write("text", "t,psi\n"), "not_a_log", "begins with 74 2C 70 73");
  refused(folder.write("short", "\xEE"), "not_a_log", "begins with EE;");
}

}  // namespace
}  // namespace mixloop
