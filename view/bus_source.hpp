// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <thread>
#include <tuple>

#include "loop/experiment.hpp"
#include "runtime/bus/bus.hpp"
#include "view/source.hpp"
#include "watch/tick_assembly.hpp"

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
  void listen();
  template <class Message>
  void on(Bytes bytes);
  void begin_session(const state_t& state);
  void add_trace(const HeardTick& tick);
  Pose pose_of(const HeardTick& tick) const;

  Experiment experiment_;
  std::int64_t config_;
  nlohmann::json path_;
  Bus bus_;
  StopSwitch stop_;
  std::tuple<Inbox<state_t>, Inbox<reference_t>, Inbox<command_t>> inboxes_;

  std::mutex mutex_;  ///< guards what follows
  TickAssembly ticks_;
  std::int64_t traced_ = -1;  ///< the newest tick in traces_
  std::int64_t version_ = 0;
  std::string note_;  ///< of the session
  Traces traces_;
  Skeleton errors_;   ///< of the listening thread
  Skeleton drawing_;  ///< of the server's
  std::thread thread_;
};

}  // namespace mixloop
