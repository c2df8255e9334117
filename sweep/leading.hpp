// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "sweep/peers.hpp"
#include "sweep/sweep.hpp"
#include "sweep/work.hpp"

namespace mixloop {

/// The other processes of a sweep, as the one sees them that leads: hands them runs, a few ahead, keeps what
/// they bring, and hands out again what one has that is silent for `patience`, or says that it can't go on.
class Leading {
 public:
  /// `said` hears of what a person should know.
  Leading(Peers& peers, const Sweep& sweep, Work& work, std::chrono::milliseconds patience,
          std::function<void(const std::string&)> said);

  /// Looks after them: what has arrived, who is silent.
  void look();
  /// They are to bring what they have begun, and no more.
  void stop();
  /// Whether none of them has anything in hand, or is waited for.
  bool is_over() const;
  /// They leave.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  struct Peer {
    enum class State { starting, at_work, lost, done } state = State::starting;
    std::string name;  ///< "rank 3 (process 123 on host)"
    Clock::time_point heard;
    int idle = 0;  ///< runs that it waits for, a message each
  };

  void take(const Peers::Message& message);
  void hand_out(int rank);
  void lose(int rank, const std::string& why);
  void tell(const std::string& message);

  Peers& peers_;
  const Sweep& sweep_;
  Work& work_;
  std::chrono::milliseconds patience_;
  std::function<void(const std::string&)> said_;
  std::vector<Peer> others_;               ///< by rank; the first is this one
  Clock::time_point told_ = Clock::now();  ///< that this one is still there
  bool stopped_ = false;
};

/// What the others do: go through the runs that the leading process hands them, `threads` at a time, until it
/// has no more, or is silent for `patience`. Whether all leave together.
bool follow(Peers& peers, const Sweep& sweep, const Engine& engine, int threads,
            const std::function<bool()>& goes_on, std::chrono::milliseconds patience);

}  // namespace mixloop
