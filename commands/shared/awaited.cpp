// SPDX-License-Identifier: MIT
#include "commands/shared/awaited.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "notation/utf8.hpp"
#include "notation/words.hpp"
#include "processes/called_as.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;

constexpr auto kTellAgain = 10s;  // where stderr is no terminal

/// What a process is heard on.
const char* channel_of(const std::string& process) {
  return process == "plant" ? "STATE" : process == "planner" ? "REFERENCE" : "COMMAND";
}

/// How ours would be started.
std::string command_of(const Launch& launch, const std::string& process) {
  std::vector<std::string> words = {own_folder() + "/mixloop-" + process,
                                    launch.experiment,
                                    "--lcm-url",
                                    launch.bus.url,
                                    "--channel-prefix",
                                    launch.bus.prefix};
  for (const auto& set : launch.sets) words.insert(words.end(), {"--set", set});
  if (launch.real_time) words.emplace_back("--realtime");
  std::string line;
  for (const auto& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return printable_name(line);
}

double seconds_since(Instant start) { return std::chrono::duration<double>(now() - start).count(); }

}  // namespace

Awaited::Awaited(const Launch& launch, std::int64_t session)
    : launch_(launch),
      bus_(launch.bus),
      start_(now()),
      told_(start_),
      progress_("waiting", static_cast<std::int64_t>(launch.first_wait * 1e3), 1e3) {
  for (const auto& process : launch.without) {
    ears_.push_back({.process = process, .session = session});
    bus_.subscribe<&Ear::on_message>(bus_.channel(channel_of(process)), &ears_.back());
    fmt::print(
        stderr,
        "mixloop: waiting up to {:g} s for a {}, to be heard on {} of {} in this network namespace; ours is "
        "started by\n  {}\n",
        launch.first_wait, process, bus_.channel(channel_of(process)), launch.bus.url,
        command_of(launch, process));
  }
}

Awaited::~Awaited() = default;

void Awaited::Ear::on_message(Bytes bytes) {
  const auto header = peek(bytes);
  heard = heard || (header && header->session != 0 && (session == 0 || header->session == session));
}

bool Awaited::look() {
  static const StopSwitch kNever;
  const auto all_there = [&] {
    return std::all_of(ears_.begin(), ears_.end(), [](const Ear& ear) { return ear.heard; });
  };
  // However much comes, the processes are looked after too.
  for (const Instant end = now() + 10ms;
       !all_there() && now() < end && bus_.wait(now(), kNever) == Wake::message;) {
  }
  if (all_there()) {
    progress_.clear();
    fmt::print(stderr, "mixloop: all are there, after {:.1f} s\n", seconds_since(start_));
    return false;
  }
  tell();
  return true;
}

void Awaited::tell() {
  progress_.at(static_cast<std::int64_t>(seconds_since(start_) * 1e3) / 64 * 64);
  if (isatty(STDERR_FILENO) == 1 || now() - told_ < kTellAgain) return;
  told_ = now();
  fmt::print(stderr, "mixloop: still waiting for a {}, {:.0f} of {:g} s\n", names(), seconds_since(start_),
             launch_.first_wait);
}

std::string Awaited::names() const {
  std::string names;
  for (const Ear& ear : ears_)
    if (!ear.heard) names += (names.empty() ? "" : " and a ") + ear.process;
  return names;
}

}  // namespace mixloop
