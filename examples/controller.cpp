// SPDX-License-Identifier: MIT
// A stranger's controller: PD on the motors, against the messages alone. The law is in torque().
#include <array>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <map>

#include "mixloop/command_t.hpp"
#include "mixloop/reference_t.hpp"
#include "mixloop/sim_control_t.hpp"
#include "mixloop/state_t.hpp"

class Controller {
 public:
  explicit Controller(lcm::LCM& bus) : bus_(bus) {
    bus.subscribe("MIXLOOP_STATE", &Controller::state, this);
    bus.subscribe("MIXLOOP_REFERENCE", &Controller::reference, this);
    bus.subscribe("MIXLOOP_SIM_CONTROL", &Controller::sim_control, this);
  }
  bool done = false;

 private:
  static double torque(int i, double psi, double psid, double psi_d, double psid_d) {
    constexpr std::array kp = {100.0, 25.0, 25.0}, kv = {1.0, 0.5, 0.5};
    return kp[i] * (psi_d - psi) + kv[i] * (psid_d - psid);
  }

  void state(const lcm::ReceiveBuffer*, const std::string&, const mixloop::state_t* message) {
    if (message->n != 3) return;  // the law above is for three motors
    state_ = *message;
    answer();
  }
  void reference(const lcm::ReceiveBuffer*, const std::string&, const mixloop::reference_t* message) {
    references_[message->seq] = *message;
    references_.erase(references_.begin(), references_.lower_bound(message->seq - 10));
    if (message->seq == state_.seq) answer();
  }
  void sim_control(const lcm::ReceiveBuffer*, const std::string&, const mixloop::sim_control_t* message) {
    done = message->action == mixloop::sim_control_t::ACTION_END && message->session == state_.session;
  }

  void
  answer() {  // STATE(k) by COMMAND(k), once REFERENCE(k) is there; a repeated state gets the same answer
    const auto desired = references_.find(state_.seq);
    if (state_.n != 3 || desired == references_.end() || desired->second.session != state_.session) return;
    mixloop::command_t command{};
    command.n = state_.n, command.utime = state_.utime, command.seq = state_.seq;
    command.session = state_.session, command.config = state_.config;
    for (int i = 0; i < state_.n; ++i)
      command.tau_commanded.push_back(torque(i, state_.psi_measured[i], state_.psid_measured[i],
                                             desired->second.psi_desired[i],
                                             desired->second.psid_desired[i]));
    bus_.publish("MIXLOOP_COMMAND", &command);
  }

  lcm::LCM& bus_;
  mixloop::state_t state_{};
  std::map<int64_t, mixloop::reference_t> references_;
};

int main() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  lcm::LCM bus(url ? url : "udpm://239.255.76.67:7667?ttl=0");
  if (!bus.good()) return std::fprintf(stderr, "no LCM: is there a multicast route?\n"), 3;
  Controller controller(bus);
  while (!controller.done)
    if (bus.handleTimeout(10'000) <= 0) return std::fprintf(stderr, "no plant for 10 s\n"), 3;
}
