// SPDX-License-Identifier: MIT
// A stranger's controller: PD on the motors, against the messages alone. The law is in torque().
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <map>

#include "mixloop_lcm/command_t.hpp"
#include "mixloop_lcm/reference_t.hpp"
#include "mixloop_lcm/sim_control_t.hpp"
#include "mixloop_lcm/state_t.hpp"

class Controller {
 public:
  explicit Controller(lcm::LCM& bus) : bus_(bus) {
    // A full queue keeps its oldest messages: the newest state must find its place.
    bus.subscribe("MIXLOOP_STATE", &Controller::state, this)->setQueueCapacity(10'000);
    bus.subscribe("MIXLOOP_REFERENCE", &Controller::reference, this)->setQueueCapacity(10'000);
    bus.subscribe("MIXLOOP_SIM_CONTROL", &Controller::sim_control, this);
  }
  bool done = false;

  /// STATE(k) by COMMAND(k), once REFERENCE(k) is there; a repeated state by the same bytes. Called when all
  /// that was waiting has been read: what the newest state has made late needs no answer.
  void answer() {
    if (!asked_) return;
    if (command_.session != state_.session || command_.seq != state_.seq) {
      const auto desired = references_.find(state_.seq);
      if (desired == references_.end() || desired->second.session != state_.session) return;
      command_ = answer_to(state_, desired->second);
    }
    bus_.publish("MIXLOOP_COMMAND", &command_);
    asked_ = false;
  }

 private:
  static double torque(int i, double psi, double psid, double psi_d, double psid_d) {
    constexpr std::array kp = {100.0, 25.0, 25.0}, kv = {1.0, 0.5, 0.5};
    return kp[i] * (psi_d - psi) + kv[i] * (psid_d - psid);
  }

  static mixloop_lcm::command_t answer_to(const mixloop_lcm::state_t& state,
                                          const mixloop_lcm::reference_t& desired) {
    mixloop_lcm::command_t command{};
    command.n = state.n, command.utime = state.utime, command.seq = state.seq;
    command.session = state.session, command.config = state.config;
    for (int i = 0; i < state.n; ++i)
      command.tau_commanded.push_back(torque(i, state.psi_measured[i], state.psid_measured[i],
                                             desired.psi_desired[i], desired.psid_desired[i]));
    return command;
  }

  void state(const lcm::ReceiveBuffer*, const std::string&, const mixloop_lcm::state_t* message) {
    if (message->n != 3) return;  // the law above is for three motors
    const auto now = std::chrono::steady_clock::now();
    const bool of_this_run = message->session == state_.session;
    // Another run on the same bus, unless ours has fallen silent.
    if (!of_this_run && state_.session != 0 && now - heard_ < std::chrono::seconds(1)) return;
    heard_ = now;
    if (of_this_run && message->seq < state_.seq) return;  // overtaken
    state_ = *message;
    asked_ = true;
  }
  void reference(const lcm::ReceiveBuffer*, const std::string&, const mixloop_lcm::reference_t* message) {
    if (message->n != 3 || (state_.session != 0 && message->session != state_.session)) return;
    references_[message->seq] = *message;
    references_.erase(references_.begin(), references_.lower_bound(message->seq - 10));
  }
  void sim_control(const lcm::ReceiveBuffer*, const std::string&, const mixloop_lcm::sim_control_t* message) {
    done = done ||
           (message->action == mixloop_lcm::sim_control_t::ACTION_END && message->session == state_.session);
  }

  lcm::LCM& bus_;
  mixloop_lcm::state_t state_{};  // the newest of the run that is followed; session 0: none was heard
  bool asked_ = false;            // it waits for its answer
  std::chrono::steady_clock::time_point heard_;
  std::map<int64_t, mixloop_lcm::reference_t> references_;
  mixloop_lcm::command_t command_{};  // the latest answer
};

int main() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  lcm::LCM bus(url ? url : "udpm://239.255.76.67:7667?ttl=0");
  if (!bus.good()) return std::fprintf(stderr, "no LCM: is there a multicast route?\n"), 3;
  Controller controller(bus);
  while (!controller.done) {
    if (bus.handleTimeout(10'000) <= 0) return std::fprintf(stderr, "no plant for 10 s\n"), 3;
    while (bus.handleTimeout(0) > 0) {
    }
    controller.answer();
  }
}
