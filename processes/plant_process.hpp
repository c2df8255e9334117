// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "loop/keep.hpp"
#include "loop/truth.hpp"
#include "processes/bus_line.hpp"
#include "processes/report_line.hpp"
#include "runtime/protocol/plant_port.hpp"

namespace mixloop {

/// The command line of mixloop-plant.
struct PlantLine : PeerLine {
  std::string speed;  ///< empty: max in lockstep, 1 in real time
  std::string out;
  bool paused = false;
  bool truth = false;
  bool hold = false;
  bool allow_faults = false;  ///< obey FAULT
  int report_fd = -1;
};

/// One session of the plant on the bus, from tick 0 to its end: its hardware, and what is recorded of it.
class PlantSession {
 public:
  PlantSession(const PlantLine& line, const Experiment& experiment, const Plan& plan, ReportLine& report);

  /// Runs it. Throws RunFault, the recorded part kept.
  Ending run(Bus& bus, const StopSwitch& stop, std::int64_t session, std::int64_t next_session);
  /// Judges and keeps it, once.
  void finish(const RunFault* fault);
  int exit_status() const { return status_; }

 private:
  PlantOptions options(std::int64_t session) const;
  PlantSide side();
  bool advance(std::int64_t k, std::span<const double> tau);
  bool finish_tick(std::int64_t k);
  bool tick_over(std::int64_t k);
  void make_safe(const char* cause);
  void take_faults(std::int64_t k);
  void on_fault(Bytes bytes);
  void add_deadlines(nlohmann::json& result) const;
  void fill(std::int64_t k, truth_t& message);
  template <class Loop>
  Ending drive(Loop& loop, std::int64_t next_session);

  const PlantLine& line_;
  const Experiment& experiment_;
  const Plan& plan_;
  DeadlinePlant hardware_;
  Recorder recorder_;
  TruthReader truth_;
  ReportLine& report_;
  PlantReport* bus_ = nullptr;
  Inbox<fault_t> faults_;
  std::int64_t fault_count_ = -1;  ///< of the sender's own count, the latest
  std::vector<Fault> heard_;       ///< faults for the end of the tick in hand
  bool fault_ = false;             ///< something was wrong at the tick last commanded
  bool finished_ = false;
  int status_ = 0;
};

/// The process: one session after the other, as the operator resets it. Its exit status.
int run_plant_process(const PlantLine& line);

}  // namespace mixloop
