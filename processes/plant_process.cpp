// SPDX-License-Identifier: MIT
#include "processes/plant_process.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "loop/arrivals_file.hpp"
#include "loop/result.hpp"
#include "processes/speed.hpp"
#include "runtime/protocol/lockstep_plant.hpp"
#include "runtime/protocol/real_time_plant.hpp"
#include "runtime/protocol/session.hpp"

namespace mixloop {
namespace {

double seconds(nanoseconds time) { return std::chrono::duration<double>(time).count(); }

void add_quantiles(nlohmann::json& result, const std::string& name, const Histogram& histogram) {
  result[name + "_p50"] = seconds(histogram.quantile(0.5));
  result[name + "_p99"] = seconds(histogram.quantile(0.99));
  result[name + "_p999"] = seconds(histogram.quantile(0.999));
  result[name + "_max"] = seconds(histogram.max());
}

nlohmann::json json_of(const Rejects& rejects) {
  nlohmann::json counts;
  for (const Reject cause : kRejects) counts[std::string(name(cause))] = rejects.of(cause);
  return counts;
}

bool saturated(const PlantSettings& settings, std::span<const double> commanded) {
  for (std::size_t i = 0; i < settings.torque_limit.size(); ++i)
    if (std::abs(commanded[i]) > settings.torque_limit[i]) return true;
  return false;
}

}  // namespace

PlantSession::PlantSession(const PlantLine& line, const Experiment& experiment, const Plan& plan,
                           ReportLine& report)
    : line_(line),
      experiment_(experiment),
      plan_(plan),
      hardware_(make_deadline_plant(experiment, plan)),
      recorder_(experiment, plan),
      truth_(experiment, recorder_),
      report_(report),
      faults_(experiment.scene->n()) {
  heard_.reserve(Faults::kWaiting);
  say_complaint(hardware_.plant().equations().complaint());
}

Ending PlantSession::run(Bus& bus, const StopSwitch& stop, std::int64_t session, std::int64_t next_session) {
  const Plant& plant = hardware_.plant();
  if (!recorder_.state(0, plant.psi(), plant.psid(), plant.work()))
    throw RunFault("diverged", "the start is already farther from the path than limits.position_error");
  const auto deafen = [](Bus* b) { b->unsubscribe(b->channel("FAULT")); };
  const std::unique_ptr<Bus, decltype(deafen)> hears(line_.allow_faults ? &bus : nullptr, deafen);
  if (hears) bus.subscribe<&PlantSession::on_fault>(bus.channel("FAULT"), this);
  if (!line_.real_time) {
    LockstepPlant lockstep(bus, stop, options(session), side());
    return drive(lockstep, next_session);
  }
  RealTimePlant real_time(bus, stop, options(session), side());
  line_.take_rights("mixloop-plant", true);
  return drive(real_time, next_session);
}

template <class Loop>
Ending PlantSession::drive(Loop& loop, std::int64_t next_session) {
  bus_ = &loop.report();
  try {
    const Ending ending = loop.run();
    if (ending == Ending::reset) {
      loop.send_reset(next_session);
      return ending;
    }
    if (ending == Ending::interrupted || ending == Ending::stopped) recorder_.interrupted();
    finish(nullptr);
    return ending;
  } catch (const RunFault& fault) {
    recorder_.interrupted();
    finish(&fault);
    throw;
  }
}

PlantOptions PlantSession::options(std::int64_t session) const {
  const std::string& speed = line_.speed;
  return {.n = experiment_.scene->n(),
          .last_tick = plan_.ticks(),
          .rate_hz = experiment_.rate_hz,
          .speed = speed_of(!speed.empty()    ? speed
                            : line_.real_time ? "1"
                                              : "max"),
          .session = session,
          .config = config_of(common_ground(experiment_)),
          .truth = line_.truth,
          .hold = line_.hold,
          .paused = line_.paused,
          .max_missed = experiment_.deadline.max_missed,
          .first_wait = line_.first_wait_ns(),
          .patience = line_.patience_ns()};
}

PlantSide PlantSession::side() {
  Plant& plant = hardware_.plant();
  PlantSide side;
  side.measure = [&plant](std::int64_t, std::span<double> psi, std::span<double> psid) {
    return plant.measure(psi, psid);
  };
  side.advance = [this](std::int64_t k, std::span<const double> tau) { return advance(k, tau); };
  side.command = [this](const command_t& command, std::int64_t offset) {
    const auto has = [&](std::int32_t flag) { return (command.flags & flag) != 0; };
    const bool blind = has(command_t::FLAG_WITHOUT_REFERENCE);
    hardware_.command({.offset = offset,
                       .command = command.seq,
                       .ahead = blind ? Arrival::kBlind : extrapolated_by(command.flags),
                       .afterwards = has(command_t::FLAG_AFTERWARDS)},
                      command.tau_commanded);
  };
  side.finish_tick = [this](std::int64_t k) { return finish_tick(k); };
  side.make_safe = [this](const char* cause) { make_safe(cause); };
  side.is_safe = [this] { return hardware_.safe().has_value(); };
  side.deadlines = [this] {
    return DeadlineCounts{.missed = hardware_.missed(),
                          .longest_miss = hardware_.longest_miss(),
                          .success_last_100 = hardware_.success_last_100()};
  };
  side.truth = [this](std::int64_t k, truth_t& message) { fill(k, message); };
  return side;
}

bool PlantSession::advance(std::int64_t k, std::span<const double> tau) {
  Plant& plant = hardware_.plant();
  take_faults(k);
  plant.command(tau);
  if (!recorder_.command(k, tau, plant.applied())) return false;
  if (tick_over(k)) return true;
  plant.advance();
  return recorder_.state(k + 1, plant.psi(), plant.psid(), plant.work());
}

bool PlantSession::finish_tick(std::int64_t k) {
  const Plant& plant = hardware_.plant();
  const bool was_safe = hardware_.safe().has_value();
  take_faults(k);
  hardware_.finish_tick();
  if (!was_safe && hardware_.safe()) recorder_.made_safe(k + 1);
  if (!recorder_.command(k, hardware_.commanded(), plant.applied())) return false;
  if (tick_over(k)) return true;
  return recorder_.state(k + 1, plant.psi(), plant.psid(), plant.work());
}

/// Faults by message act from the tick in hand on, once its sensors are read: wherever in it they arrived.
void PlantSession::take_faults(std::int64_t k) {
  for (const Fault& fault : heard_) hardware_.inject(fault);
  heard_.clear();
  const Faults* faults = hardware_.plant().faults();
  recorder_.note_changes(k, faults);
  fault_ = faults && faults->active();
}

/// A fault of the operator's, for this session. A repeated one is taken once; what can't be is left alone.
void PlantSession::on_fault(Bytes bytes) {
  const auto reject = [this](Reject cause) { bus_->rejects.count(cause); };
  if (bus_ == nullptr) return;
  if (const auto cause = faults_.read(bytes)) return reject(*cause);
  const fault_t& m = faults_.message;
  if (m.session != bus_->session) return reject(Reject::session);
  if (m.seq <= fault_count_) return reject(Reject::stale);
  if (m.target < fault_t::TARGET_MOTOR || m.target > fault_t::TARGET_FRICTION) return;
  if (m.kind < fault_t::KIND_NONE || m.kind > fault_t::KIND_CHANGED) return;
  fault_count_ = m.seq;
  if (heard_.size() == heard_.capacity()) return;
  heard_.push_back({.target = static_cast<Fault::Target>(m.target),
                    .kind = static_cast<Fault::Kind>(m.kind),
                    .index = m.index,
                    .magnitude = m.magnitude,
                    .at = 1e-6 * static_cast<double>(m.utime),
                    .duration = m.duration});
}

void PlantSession::make_safe(const char* cause) {
  if (hardware_.safe()) return;
  hardware_.make_safe(cause);
  recorder_.made_safe(hardware_.plant().tick());
}

/// True where tick k was the last one.
bool PlantSession::tick_over(std::int64_t k) {
  report_.tick(k);
  if (k != plan_.ticks()) return false;
  if (!line_.hold) return true;
  finish(nullptr);
  if (line_.report_fd < 0) fmt::print(stderr, "mixloop-plant: holding the end point; Ctrl-C ends it\n");
  return false;
}

void PlantSession::fill(std::int64_t k, truth_t& message) {
  const Truth& truth = truth_.at(k);
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), std::begin(to)); };
  copy(recorder_.psi(k), message.psi);
  copy(recorder_.psid(k), message.psid);
  copy(truth.psidd, message.psidd);
  copy(recorder_.applied(k), message.tau_applied);
  copy(truth.position, message.position);
  copy(truth.velocity, message.velocity);
  copy(truth.acceleration, message.acceleration);
  message.kinetic_energy = truth.kinetic_energy;
  message.potential_energy = truth.potential_energy;
  message.work = truth.work;
  message.flags = (saturated(experiment_.plant, recorder_.commanded(k)) ? truth_t::FLAG_SATURATED : 0) |
                  (fault_ ? truth_t::FLAG_FAULT : 0);
}

void PlantSession::add_deadlines(nlohmann::json& result) const {
  result["missed_deadlines"] = hardware_.missed();
  result["longest_miss"] = hardware_.longest_miss();
  result["success_last_100"] = hardware_.success_last_100();
  result["overruns"] = bus_->overruns;
  if (const auto& safe = hardware_.safe()) {
    result["safe_cause"] = safe->cause;
    result["safe_state"] = name_of(experiment_.deadline.safe_state);
  }
}

/// What was recorded before a fault is kept too.
void PlantSession::finish(const RunFault* fault) {
  if (finished_) return;
  finished_ = true;
  auto result = result_json(experiment_, recorder_.measures(), line_.real_time ? "real_time" : "lockstep",
                            seconds(bus_->wall_time));
  result["missed_deadlines"] = 0;  // lockstep waits
  if (line_.real_time) add_deadlines(result);
  result["resent"] = bus_->resent;
  add_quantiles(result, "round_trip", bus_->round_trip);
  if (bus_->wake_up.count() > 0) add_quantiles(result, "wake_up", bus_->wake_up);
  result["session"] = bus_->session;
  result["slipped"] = seconds(bus_->slipped);
  result["rejected"] = bus_->rejects.total();
  result["rejected_by_cause"] = json_of(bus_->rejects);
  result["joined_late"] = bus_->joined_late > 0;
  if (fault) {
    result["verdict"] = "fault";
    result["exit_status"] = kRunFault;
    result["error"] = {{"code", fault->code}, {"message", fault->what()}, {"where", ""}};
  }
  status_ = result.at("exit_status").get<int>();
  if (!line_.out.empty()) {
    report_.keeping();
    keep(line_.out, experiment_, plan_, recorder_, result);
    if (line_.real_time) write_arrivals(std::filesystem::path(line_.out) / "ages.csv", hardware_.arrivals());
  }
  report_.result(result);
  if (fault) return;  // the command line tells it
  if (line_.json)
    print_json(result);
  else if (line_.report_fd < 0)
    fmt::print("{}", summary(experiment_, result));
  std::fflush(stdout);
}

int run_plant_process(const PlantLine& line) {
  StopSwitch stop;
  stop.turn_on_signals();
  Experiment loaded = line.load();
  loaded.plant.faults.injected = line.allow_faults;
  const Plan plan = make_plan(loaded);
  const Experiment experiment = with_integrator_settled(loaded, plan);
  ReportLine report(line.report_fd);
  if (!line.out.empty()) prepare_folder(line.out);
  Bus bus(line.bus);
  for (std::int64_t session = line.session;;) {
    PlantSession run(line, experiment, plan, report);
    const std::int64_t next = draw_session();
    if (run.run(bus, stop, session, next) != Ending::reset) return run.exit_status();
    if (line.report_fd < 0) fmt::print(stderr, "mixloop-plant: reset, to tick 0 of a new session\n");
    session = next;
  }
}

}  // namespace mixloop
