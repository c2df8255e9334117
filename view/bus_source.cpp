// SPDX-License-Identifier: MIT
#include "view/bus_source.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/protocol/config_hash.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kTicksKept = 20'000;              // of the live plots
constexpr std::size_t kMostPoints = 600;                // of them in one message
constexpr auto kBreath = std::chrono::milliseconds(8);  // between two looks at the bus: fewer wake-ups

nlohmann::json desired_path(const Experiment& experiment) {
  const Plan plan = make_plan(experiment);
  std::vector<Eigen::Vector3d> path;
  if (!plan.has_path()) return path_json(path);
  for (std::int64_t k = plan.start_tick(); k <= plan.ticks(); ++k) path.push_back(plan.at(k).position);
  return path_json(path);
}

const Experiment& with_all_measured(const Experiment& experiment) {
  if (experiment.plant.sensors.unmeasured.empty()) return experiment;
  throw InputError(
      "not_measured", {experiment.file.string()},
      "the plant's sensors leave free coordinates unmeasured (plant.sensors.free), so STATE doesn't say "
      "how they stand and no pose can be drawn; expected what `mixloop run --out` keeps, or all of them "
      "measured");
}

}  // namespace

BusSource::BusSource(const BusOptions& bus, const Experiment& experiment, std::int64_t config)
    : experiment_(with_all_measured(experiment)),
      config_(config),
      path_(desired_path(experiment)),
      bus_(bus),
      inboxes_(experiment.scene->n(), experiment.scene->n_u(), experiment.scene->n_u()),
      // A tick goes into the plots when its command is in, or at the latest when the next state is.
      ticks_({.patience = 1,
              .complete = [](const HeardTick& tick) { return tick.get<state_t>() && tick.get<command_t>(); },
              .on_tick = [this](const HeardTick& tick) { add_trace(tick); }}),
      traces_(experiment.scene->motors().size(), kTicksKept),
      errors_(experiment.scene, experiment.plant_parameters),
      drawing_(experiment.scene, experiment.plant_parameters) {
  bus_.subscribe<&BusSource::on<state_t>>(bus_.channel("STATE"), this);
  bus_.subscribe<&BusSource::on<reference_t>>(bus_.channel("REFERENCE"), this);
  bus_.subscribe<&BusSource::on<command_t>>(bus_.channel("COMMAND"), this);
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
  ticks_.begin(state.session, state.seq);
  const std::string difference = name_difference(config_, state.config);
  note_ = difference.empty() ? "" : "The plant runs another experiment: its " + difference + " differ.";
  traced_ = -1;
  traces_.clear();
}

template <class Message>
void BusSource::on(Bytes bytes) {
  auto& inbox = std::get<Inbox<Message>>(inboxes_);
  if (inbox.read(bytes)) return;
  const Message& message = inbox.message;
  const std::lock_guard lock(mutex_);
  if constexpr (std::is_same_v<Message, state_t>)
    if (message.seq >= 0 && message.session != ticks_.session()) begin_session(message);
  const bool fresh = ticks_.add(message) == Taken::fresh;
  if (fresh && !std::is_same_v<Message, reference_t> && message.seq == ticks_.newest()) ++version_;
}

void BusSource::add_trace(const HeardTick& tick) {
  if (!tick.get<state_t>()) return;
  traced_ = tick.k;
  const Pose pose = pose_of(tick);
  errors_.place(pose.psi, pose.t);
  traces_.add(
      trace_of(pose.t, errors_.end_effector(), pose.desired, experiment_.scene->end_effector.axes, pose.tau));
}

/// Of a tick that has its state.
Pose BusSource::pose_of(const HeardTick& tick) const {
  const state_t& state = *tick.get<state_t>();
  Pose pose{.k = tick.k,
            .t = static_cast<double>(tick.k) / experiment_.rate_hz,
            .session = state.session,
            .psi = state.psi_measured,
            .tau = std::vector<double>(experiment_.scene->motors().size(), NAN),
            .flags = state.flags,
            .note = note_};
  if (const auto* command = tick.get<command_t>()) pose.tau = command->tau_commanded;
  if (const auto* reference = tick.get<reference_t>())
    pose.desired = Eigen::Map<const Eigen::Vector3d>(reference->position_desired);
  return pose;
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
    // The newest tick that is whole, unless nobody commands.
    const bool whole = traced_ >= 0 && ticks_.newest() - traced_ <= 1;
    const HeardTick* tick = ticks_.find(whole ? traced_ : ticks_.newest());
    if (!tick) return {};
    pose = pose_of(*tick);
    traces = traces_.since(std::max<std::int64_t>(cursor.traces, 0), kMostPoints);
    cursor.traces = traces_.count();
  }
  return pose_json(drawing_, pose, traces);
}

}  // namespace mixloop
