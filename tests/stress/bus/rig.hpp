// SPDX-License-Identifier: MIT
// The three processes on a bus, started by hand, and an ear that holds every torque to its limit.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/bus.hpp"
#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "tests/support/command.hpp"

namespace mixloop::stress {

enum class Part : std::uint8_t { planner, controller, plant };
inline constexpr std::array kParts = {Part::planner, Part::controller, Part::plant};
std::string name_of(Part part);

/// How much a process may grow: a sanitizer keeps what is freed.
constexpr double growth_bound(double kilobytes) { return MIXLOOP_SANITIZED ? 1e9 : kilobytes; }

class BusRig {
 public:
  /// The paper's robot, its line there and back for a minute. `more` are options of all three, `of_plant` of
  /// the plant alone. Nothing is started.
  explicit BusRig(std::vector<std::string> more = {}, std::vector<std::string> of_plant = {});

  void start(Part part);
  void start_all();
  void kill(Part part);  ///< SIGKILL, and waits for its end
  Command& process(Part part) { return *processes_[static_cast<std::size_t>(part)]; }
  /// Resident memory of a process, kB.
  long memory(Part part) const;

  /// Listens until `condition` holds; false after the limit or once a process has ended by itself.
  bool until(const std::function<bool()>& condition, nanoseconds limit);
  void listen(nanoseconds time);
  /// Takes what waits.
  void hear();

  /// Resets the plant, and listens until the new session runs: commands of the law past tick 20. A session
  /// that the machine held up for so long at once that it is in its safe state again is reset again.
  bool reset();
  /// The same for a session other than `old` that begins by itself.
  bool runs_anew(std::int64_t old);
  bool in_safe_state() const { return (state.flags & state_t::FLAG_SAFE_STATE) != 0; }
  /// What was heard last, and what the processes said.
  std::string describe();
  bool all_alive();

  Bus bus;
  state_t state = blank<state_t>(kMotors);        ///< the latest heard
  command_t command = blank<command_t>(kMotors);  ///< the latest heard
  std::int64_t answered = -1;                     ///< the newest tick whose command was heard, of any session
  std::optional<timing_t> timing;                 ///< the latest heard
  std::array<std::vector<std::uint8_t>, 3>
      first_bytes;  ///< of STATE, REFERENCE, COMMAND: an early message each
  double worst_torque =
      0;  ///< commanded or applied, as a share of its limit; infinite where it is not finite
  std::int64_t torques = 0;  ///< looked at
  std::int64_t held_up = 0;  ///< sessions that the machine brought into their safe state

  static constexpr int kMotors = 3;

 private:
  void on_state(Bytes bytes);
  void on_reference(Bytes bytes);
  void on_command(Bytes bytes);
  void on_truth(Bytes bytes);
  void on_timing(Bytes bytes);
  void look(const std::vector<double>& torque);
  void send_reset();

  std::vector<std::string> more_, of_plant_;
  std::array<std::unique_ptr<Command>, kParts.size()> processes_;
  StopSwitch never_;
  Inbox<state_t> states_{kMotors};
  Inbox<command_t> commands_{kMotors};
  Inbox<truth_t> truths_{kMotors};
  Inbox<timing_t> timings_{kMotors};
};

}  // namespace mixloop::stress
