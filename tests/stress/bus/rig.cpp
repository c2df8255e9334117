// SPDX-License-Identifier: MIT
#include "tests/stress/bus/rig.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>

#include "runtime/clock/plant_time.hpp"

namespace mixloop::stress {
namespace {

using namespace std::chrono_literals;

// The paper's line takes 1.9, 4.8 and 2.5 N m.
constexpr std::array kTorqueLimit = {3.0, 8.0, 4.0};

// Long for a process that begins in 0.1 s: who takes longer hangs.
constexpr auto kHang = 30s;

}  // namespace

std::string name_of(Part part) {
  return std::array{"planner", "controller", "plant"}[static_cast<std::size_t>(part)];
}

BusRig::BusRig(std::vector<std::string> more, std::vector<std::string> of_plant)
    : more_(std::move(more)), of_plant_(std::move(of_plant)) {
  bus.subscribe<&BusRig::on_state>(bus.channel("STATE"), this);
  bus.subscribe<&BusRig::on_reference>(bus.channel("REFERENCE"), this);
  bus.subscribe<&BusRig::on_command>(bus.channel("COMMAND"), this);
  bus.subscribe<&BusRig::on_truth>(bus.channel("TRUTH"), this);
  bus.subscribe<&BusRig::on_timing>(bus.channel("TIMING"), this);
}

void BusRig::start(Part part) {
  std::vector<std::string> words = {MIXLOOP_BIN "/mixloop-" + name_of(part),
                                    MIXLOOP_EXPERIMENTS "/soak.yaml",
                                    "--set",
                                    "plant.torque_limit=[3, 8, 4]",
                                    "--set",
                                    "controller.safety.torque_limit=[3, 8, 4]"};
  words.insert(words.end(), more_.begin(), more_.end());
  if (part == Part::plant) {
    words.insert(words.end(), {"--hold", "--truth", "--json"});
    words.insert(words.end(), of_plant_.begin(), of_plant_.end());
  }
  processes_[static_cast<std::size_t>(part)] = std::make_unique<Command>(words);
}

void BusRig::start_all() {
  for (const Part part : kParts) start(part);
}

void BusRig::kill(Part part) {
  process(part).signal(SIGKILL);
  process(part).wait();
}

long BusRig::memory(Part part) const {
  std::ifstream statm("/proc/" + std::to_string(processes_[static_cast<std::size_t>(part)]->pid()) +
                      "/statm");
  long size = 0, resident = 0;
  statm >> size >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

void BusRig::hear() {
  while (bus.wait(now(), never_) == Wake::message) {
  }
}

bool BusRig::until(const std::function<bool()>& condition, nanoseconds limit) {
  const Instant end = now() + limit;
  Instant look = now() + 100ms;
  while (!condition()) {
    if (now() > end) return false;
    if (now() > look) {
      if (!all_alive()) return false;
      look = now() + 100ms;
    }
    bus.wait(std::min(end, now() + 10ms), never_);
  }
  return true;
}

void BusRig::listen(nanoseconds time) {
  const Instant end = now() + time;
  while (now() < end) bus.wait(end, never_);
}

bool BusRig::all_alive() {
  return std::all_of(processes_.begin(), processes_.end(), [](const auto& p) { return p && p->running(); });
}

bool BusRig::reset() {
  const std::int64_t old = state.session;
  send_reset();
  return runs_anew(old);
}

bool BusRig::runs_anew(std::int64_t old) {
  const auto runs = [&] {
    return command.session == state.session && command.seq >= 20 && command.seq <= state.seq &&
           (command.flags & command_t::FLAG_SAFE) == 0 && !in_safe_state();
  };
  for (const Instant end = now() + kHang; now() < end; ++held_up) {
    if (!until([&] { return state.session != old && (runs() || in_safe_state()); }, end - now()))
      return false;
    if (!in_safe_state()) return true;
    old = state.session;
    send_reset();
  }
  return false;
}

void BusRig::send_reset() {
  Outbox<sim_control_t> out(kMotors);
  set_header(out.message, {.n = kMotors, .session = state.session, .config = state.config});
  out.message.action = sim_control_t::ACTION_RESET;
  bus.publish(bus.channel("SIM_CONTROL"), out.encode());
}

std::string BusRig::describe() {
  std::string text = fmt::format(
      "STATE {} of {:x}, flags {}; COMMAND {} of {:x}, flags {}; {} sessions were held up so far\n",
      state.seq, state.session, state.flags, command.seq, command.session, command.flags, held_up);
  for (const Part part : kParts) {
    Command& p = process(part);
    const std::string fate = p.running() ? "runs" : fmt::format("has ended with status {}", p.wait());
    text += fmt::format("{} {}: {}\n", name_of(part), fate, p.err());
  }
  return text;
}

void BusRig::on_state(Bytes bytes) {
  if (first_bytes[0].empty()) first_bytes[0].assign(bytes.begin(), bytes.end());
  if (!states_.read(bytes)) std::swap(state, states_.message);
}

void BusRig::on_reference(Bytes bytes) {
  if (first_bytes[1].empty()) first_bytes[1].assign(bytes.begin(), bytes.end());
}

void BusRig::on_command(Bytes bytes) {
  if (first_bytes[2].empty()) first_bytes[2].assign(bytes.begin(), bytes.end());
  if (commands_.read(bytes)) return;
  const command_t& heard = commands_.message;
  if (heard.session == state.session && heard.config == state.config && heard.seq <= kFarthestTick)
    answered = std::max(answered, heard.seq);
  look(heard.tau_commanded);
  std::swap(command, commands_.message);
}

void BusRig::on_truth(Bytes bytes) {
  if (!truths_.read(bytes)) look(truths_.message.tau_applied);
}

void BusRig::on_timing(Bytes bytes) {
  if (!timings_.read(bytes)) timing = timings_.message;
}

void BusRig::look(const std::vector<double>& torque) {
  ++torques;
  for (std::size_t i = 0; i < torque.size(); ++i) {
    const double share = std::abs(torque[i]) / kTorqueLimit[i];
    worst_torque = std::max(worst_torque, share == share ? share : HUGE_VAL);
  }
}

}  // namespace mixloop::stress
