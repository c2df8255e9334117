// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <mutex>
#include <thread>

#include "loop/experiment.hpp"
#include "runtime/bus/bus.hpp"
#include "view/source.hpp"

namespace mixloop {

/// A live run. A thread of its own empties the bus now and then and keeps the newest tick; it sends nothing,
/// and no browser can hold it up.
class BusSource : public Source {
 public:
  /// `config`: what the messages of a run of this experiment carry. Throws what Bus throws, and what
  /// make_plan throws for the experiment's path.
  BusSource(const BusOptions& bus, const Experiment& experiment, std::int64_t config);
  ~BusSource() override;

  std::string description() override;
  std::int64_t version() override;
  std::string newest(Cursor& cursor) override;

 private:
  static constexpr std::size_t kSlots = 64;  ///< ticks that messages may be apart

  struct Slot {
    std::int64_t state = -1, reference = -1, command = -1;  ///< the ticks that these are of
    Pose pose;
    Eigen::Vector3d desired;
    std::vector<double> tau;
  };
  Slot& slot(std::int64_t k) { return slots_[static_cast<std::size_t>(k) % kSlots]; }

  void listen();
  void on_state(Bytes bytes);
  void on_reference(Bytes bytes);
  void on_command(Bytes bytes);
  void begin_session(const state_t& state);
  void finish_tick(std::int64_t k);

  Experiment experiment_;
  std::int64_t config_;
  nlohmann::json path_;
  Bus bus_;
  StopSwitch stop_;
  Inbox<state_t> state_;
  Inbox<reference_t> reference_;
  Inbox<command_t> command_;

  std::mutex mutex_;  ///< guards what follows
  std::array<Slot, kSlots> slots_;
  std::int64_t session_ = 0, latest_ = -1, finished_ = -1, version_ = 0;
  std::string note_;  ///< of the session
  Traces traces_;
  Skeleton errors_;   ///< of the listening thread
  Skeleton drawing_;  ///< of the server's
  std::thread thread_;
};

}  // namespace mixloop
