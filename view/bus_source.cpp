// SPDX-License-Identifier: MIT
#include "view/bus_source.hpp"

#include <algorithm>
#include <cmath>

#include "report/position_error.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kTicksKept = 20'000;              // of the live plots
constexpr std::size_t kMostPoints = 600;                // of them in one message
constexpr auto kBreath = std::chrono::milliseconds(8);  // between two looks at the bus: fewer wake-ups

nlohmann::json desired_path(const Experiment& experiment) {
  const Plan plan = make_plan(experiment);
  std::vector<Eigen::Vector3d> path;
  for (std::int64_t k = plan.start_tick(); k <= plan.ticks(); ++k) path.push_back(plan.at(k).position);
  return path_json(path);
}

}  // namespace

BusSource::BusSource(const BusOptions& bus, const Experiment& experiment, std::int64_t config)
    : experiment_(experiment),
      config_(config),
      path_(desired_path(experiment)),
      bus_(bus),
      state_(experiment.scene->n()),
      reference_(experiment.scene->n_u()),
      command_(experiment.scene->n_u()),
      traces_(experiment.scene->motors().size(), kTicksKept),
      errors_(experiment.scene, experiment.plant_parameters),
      drawing_(experiment.scene, experiment.plant_parameters) {
  for (auto& slot : slots_) {
    slot.pose.psi.resize(static_cast<std::size_t>(experiment.scene->n()));
    slot.tau.resize(experiment.scene->motors().size());
  }
  bus_.subscribe<&BusSource::on_state>(bus_.channel("STATE"), this);
  bus_.subscribe<&BusSource::on_reference>(bus_.channel("REFERENCE"), this);
  bus_.subscribe<&BusSource::on_command>(bus_.channel("COMMAND"), this);
  thread_ = std::thread([this] { listen(); });
}

BusSource::~BusSource() {
  stop_.turn();
  thread_.join();
}

void BusSource::listen() {
  while (!stop_.turned()) {
    sleep_until(now() + kBreath);
    while (bus_.wait(Instant(0), stop_) == Wake::message) {
    }
  }
}

// The first STATE's session; another takes its place at once: a plant was started again.
void BusSource::begin_session(const state_t& state) {
  session_ = state.session;
  const std::string difference = name_difference(config_, state.config);
  note_ = difference.empty() ? "" : "The plant runs another experiment: its " + difference + " differ.";
  latest_ = finished_ = -1;
  traces_.clear();
  for (auto& slot : slots_) slot.state = slot.reference = slot.command = -1;
}

void BusSource::on_state(Bytes bytes) {
  if (state_.read(bytes)) return;
  const auto& message = state_.message;
  const std::lock_guard lock(mutex_);
  if (message.seq < 0) return;
  if (message.session != session_) begin_session(message);
  if (message.seq <= latest_) return;
  if (latest_ >= 0) finish_tick(latest_);
  latest_ = message.seq;
  Slot& at = slot(latest_);
  at.state = latest_;
  at.pose.k = latest_;
  at.pose.t = static_cast<double>(latest_) / experiment_.rate_hz;
  at.pose.session = message.session;
  at.pose.flags = message.flags;
  std::copy(message.psi_measured.begin(), message.psi_measured.end(), at.pose.psi.begin());
  ++version_;
}

void BusSource::on_reference(Bytes bytes) {
  if (reference_.read(bytes)) return;
  const auto& message = reference_.message;
  const std::lock_guard lock(mutex_);
  if (message.seq < 0 || message.session != session_) return;
  Slot& at = slot(message.seq);
  at.reference = message.seq;
  at.desired = Eigen::Map<const Eigen::Vector3d>(message.position_desired);
}

void BusSource::on_command(Bytes bytes) {
  if (command_.read(bytes)) return;
  const auto& message = command_.message;
  const std::lock_guard lock(mutex_);
  if (message.seq < 0 || message.session != session_) return;
  Slot& at = slot(message.seq);
  at.command = message.seq;
  std::copy(message.tau_commanded.begin(), message.tau_commanded.end(), at.tau.begin());
  if (message.seq == latest_) finish_tick(latest_), ++version_;
}

// A tick goes into the plots once: when its command is in, or at the latest when the next state is.
void BusSource::finish_tick(std::int64_t k) {
  Slot& at = slot(k);
  if (k <= finished_ || at.state != k) return;
  finished_ = k;
  Trace trace{.t = at.pose.t, .error = NAN, .tau = std::vector<float>(at.tau.size(), NAN)};
  if (at.command == k) std::copy(at.tau.begin(), at.tau.end(), trace.tau.begin());
  errors_.place(at.pose.psi, at.pose.t);
  const Eigen::Vector3d E = errors_.end_effector();
  for (std::size_t i = 0; i < 3; ++i) trace.place[i] = static_cast<float>(E[static_cast<Eigen::Index>(i)]);
  if (at.reference == k)
    trace.error = static_cast<float>(position_error(E, at.desired, experiment_.scene->end_effector.axes));
  traces_.add(std::move(trace));
}

std::string BusSource::description() {
  return nlohmann::json{{"mode", "live"},
                        {"label", experiment_.name},
                        {"rate", experiment_.rate_hz},
                        {"mechanism", drawing_.description()},
                        {"path", path_},
                        {"torque_limit", experiment_.plant.torque_limit}}
      .dump();
}

std::int64_t BusSource::version() {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::string BusSource::newest(Cursor& cursor) {
  Pose pose;
  std::string traces;
  {
    const std::lock_guard lock(mutex_);
    cursor.version = version_;
    if (latest_ < 0) return {};
    // The newest tick that is whole, unless nobody commands.
    const std::int64_t k = finished_ >= 0 && latest_ - finished_ <= 1 ? finished_ : latest_;
    const Slot& at = slot(k);
    pose = at.pose;
    pose.note = note_;
    pose.tau.assign(at.tau.size(), NAN);
    if (at.command == k) pose.tau = at.tau;
    if (at.reference == k) pose.desired = at.desired;
    traces = traces_.since(std::max<std::int64_t>(cursor.traces, 0), kMostPoints);
    cursor.traces = traces_.count();
  }
  return pose_json(drawing_, pose, traces);
}

}  // namespace mixloop
