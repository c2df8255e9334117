// SPDX-License-Identifier: MIT
#pragma once

#include "loop/recorded_plant.hpp"
#include "processes/plant_line.hpp"
#include "processes/report_line.hpp"
#include "runtime/clock/stop_switch.hpp"
#include "runtime/protocol/plant_runner.hpp"

namespace mixloop {

/// One session of the plant on the bus, from tick 0 to its end. What is passed must outlive it.
class PlantSession {
 public:
  /// Throws InputError("too_large") where there is no room for the record.
  PlantSession(const PlantLine& line, const Experiment& experiment, const Plan& plan, ReportLine& report);

  /// Runs it and, unless it is reset, judges and keeps it. Throws RunFault, the recorded part kept.
  Ending run(Bus& bus, const StopSwitch& stop, std::int64_t session, std::int64_t next_session);
  int exit_status() const { return status_; }

 private:
  template <class Runner, class Hardware>
  Ending run_as(Bus& bus, const StopSwitch& stop, std::int64_t session, std::int64_t next_session);
  Ending drive(PlantRunner& runner, std::int64_t next_session);
  bool goes_on(std::int64_t k);
  void finish(const RunFault* fault);

  const PlantLine& line_;
  RecordedPlant run_;
  ReportLine& report_;
  const PlantReport* bus_ = nullptr;
  bool finished_ = false;
  int status_ = 0;
};

}  // namespace mixloop
