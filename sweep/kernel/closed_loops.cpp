// SPDX-License-Identifier: MIT
#include "sweep/kernel/closed_loops.hpp"

#include <dlfcn.h>

#include <array>
#include <cmath>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "dynamics/program/processor.hpp"
#include "dynamics/program/shared_object.hpp"
#include "notation/sha256.hpp"
#include "plant/hardware.hpp"
#include "plant/plant_model.hpp"
#include "sweep/kernel/loop_data.hpp"

namespace mixloop {

using mixloop_loop::Common, mixloop_loop::Each, mixloop_loop::Told;

/// Compiled, for so many runs at once.
class ClosedLoopKernel {
 public:
  using Symbol = std::function<void*(const std::string& name)>;

  ClosedLoopKernel(const Symbol& symbol, int lanes)
      : lanes_(lanes), run_(reinterpret_cast<Run>(symbol("closed_loops_" + std::to_string(lanes)))) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      set_up_[i] = reinterpret_cast<SetUp>(symbol(std::string(kNames[i]) + "_set_up"));
      const auto* count = static_cast<const int*>(symbol(std::string(kNames[i]) + "_constants"));
      constants_[i] = count ? static_cast<std::size_t>(*count) : 0;
    }
  }

  static constexpr std::array kNames = {"plant", "mass", "bias", "hand"};

  std::size_t constants(std::size_t program) const { return constants_[program]; }
  void set_up(std::size_t program, std::span<const double> parameters, double* k) const {
    if (set_up_[program]) set_up_[program](parameters.data(), k);
  }
  void run(const Common& common, const Each& each, const Told& told) const {
    for (int first = 0; first < common.runs; first += lanes_) run_(&common, &each, &told, first);
  }

 private:
  using Run = void (*)(const Common*, const Each*, const Told*, int);
  using SetUp = void (*)(const double*, double*);
  int lanes_;
  Run run_;
  std::array<SetUp, 4> set_up_{};
  std::array<std::size_t, 4> constants_{};
};

namespace {

bool takes_mass(Law law) { return law == Law::pd_feedforward || law == Law::computed_torque; }
bool takes_bias(Law law) { return law == Law::pd_gravity || law == Law::computed_torque; }

KernelParts parts_of(const Experiment& experiment) {
  const Law law = experiment.controller.law;
  return {.plant = experiment.scene,
          .controller = experiment.controller_scene,
          .feedforward = takes_mass(law),
          .bias = takes_bias(law),
          .sensors = experiment.plant.sensors.any(),
          .drives = experiment.plant.actuators.any()};
}

/// Numbers of runs side by side: number i of run r at [i * runs + r].
class Rows {
 public:
  Rows(std::size_t numbers, std::size_t runs) : runs_(runs), values_(numbers * runs) {}
  double* data() { return values_.data(); }
  double& at(std::size_t i, std::size_t run) { return values_[i * runs_ + run]; }
  template <class Numbers>
  void put(std::size_t run, const Numbers& numbers) {
    std::size_t i = 0;
    for (const double number : numbers) at(i++, run) = number;
  }

 private:
  std::size_t runs_;
  std::vector<double> values_;
};

/// Runs of one kernel, their numbers and what becomes of them.
class Group {
 public:
  /// `references`: a plan's rows.
  Group(std::span<const PreparedRun* const> runs, const ClosedLoopKernel& kernel,
        const std::vector<double>& references, const Telling& telling)
      : runs_(runs), telling_(telling), plan_(*runs[0]->plan), n_(plan_.n_u()), references_(references) {
    const std::size_t count = runs.size();
    for (auto* rows : {&psi0_, &kp_, &kv_, &torque_limit_, &most_torque_})
      *rows = Rows(static_cast<std::size_t>(n_), count);
    for (std::size_t p = 0; p < 4; ++p) constants_[p] = Rows(kernel.constants(p), count);
    drives_ = Rows(static_cast<std::size_t>(mixloop_loop::kDriveNumbers * n_), count);
    sensors_ = Rows(static_cast<std::size_t>(mixloop_loop::kSensorNumbers * n_), count);
    sensor_delay_ = Rows(static_cast<std::size_t>(n_), count);
    std::size_t longest = 0;
    for (std::size_t r = 0; r < count; ++r) longest = std::max(longest, take(r, kernel));
    ring_ticks_ = static_cast<int>(longest) + 2;
    ring_ = Rows(static_cast<std::size_t>(ring_ticks_ * n_), count);
    sensor_ring_ = Rows(static_cast<std::size_t>(sensor_ticks_ * 2 * n_), count);
    if (telling.hashes) trajectory_ = Rows(static_cast<std::size_t>((plan_.ticks() + 1) * 3 * n_), count);
    kernel.run(common(), each(), told());
  }

  Measures measures(std::size_t run);

 private:
  std::size_t take(std::size_t run, const ClosedLoopKernel& kernel);
  void take_hardware(std::size_t run);
  Common common() const;
  Each each();
  Told told();

  std::span<const PreparedRun* const> runs_;
  const Telling& telling_;
  const Plan& plan_;
  int n_, ring_ticks_ = 0, sensor_ticks_ = 1;
  const std::vector<double>& references_;
  Rows psi0_{0, 0}, kp_{0, 0}, kv_{0, 0}, torque_limit_{0, 0}, most_torque_{0, 0};
  Rows error_limit_{1, runs_.size()}, delay_ticks_{1, runs_.size()}, delay_rest_{1, runs_.size()};
  std::array<Rows, 4> constants_{Rows{0, 0}, Rows{0, 0}, Rows{0, 0}, Rows{0, 0}};
  Rows drives_{0, 0}, sensors_{0, 0}, sensor_delay_{0, 0}, velocity_share_{1, runs_.size()};
  std::vector<unsigned long long> seeds_ = std::vector<unsigned long long>(runs_.size());
  Rows told_{7, runs_.size()}, ring_{0, 0}, sensor_ring_{0, 0}, trajectory_{0, 0};
};

/// A plan's references, tick by tick.
std::vector<double> rows_of(const Plan& plan) {
  std::vector<double> rows;
  rows.reserve(static_cast<std::size_t>(plan.ticks() + 1) * reference_size(plan.n_u()));
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    const Reference at = plan.at(k);
    for (const auto* values : {&at.psi, &at.psid, &at.psidd})
      rows.insert(rows.end(), values->begin(), values->end());
    for (const auto* values : {&at.position, &at.velocity, &at.acceleration})
      rows.insert(rows.end(), values->begin(), values->end());
  }
  return rows;
}

/// How many ticks its command is late.
std::size_t Group::take(std::size_t run, const ClosedLoopKernel& kernel) {
  const Experiment& experiment = runs_[run]->experiment;
  const PlantModel model = plant_model(experiment.plant, *experiment.scene, experiment.rate_hz);
  psi0_.put(run, plan_.at(0).psi);
  kp_.put(run, experiment.controller.kp);
  kv_.put(run, experiment.controller.kv);
  for (std::size_t i = 0; i < model.n_u; ++i)
    torque_limit_.at(i, run) = model.torque_limit.empty() ? HUGE_VAL : model.torque_limit[i];
  error_limit_.at(0, run) = experiment.position_error_limit;
  delay_ticks_.at(0, run) = static_cast<double>(model.delay_ticks);
  delay_rest_.at(0, run) = model.delay_rest;
  for (std::size_t p = 0; p < 4; ++p) {
    std::vector<double> k(kernel.constants(p));
    const bool of_plant = p == 0 || p == 3;
    kernel.set_up(p, of_plant ? experiment.plant_parameters : experiment.controller_parameters, k.data());
    constants_[p].put(run, k);
  }
  if (Hardware::needed(experiment.plant)) take_hardware(run);
  return model.delay_ticks;
}

void Group::take_hardware(std::size_t run) {
  const Experiment& experiment = runs_[run]->experiment;
  const Hardware hardware(experiment.plant, *experiment.scene, experiment.rate_hz);
  const auto n = static_cast<std::size_t>(n_);
  if (const auto& actuators = hardware.actuators)
    for (std::size_t i = 0; i < n; ++i) {
      const auto& drive = actuators->drives()[i];
      std::size_t what = 0;
      for (const double number :
           {drive.rate, drive.lag, drive.ripple, drive.per_turn, drive.viscous, drive.coulomb, drive.smooth})
        drives_.at(what++ * n + i, run) = number;
    }
  if (const auto& sensors = hardware.sensors) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto& channel = sensors->channels()[i];
      std::size_t what = 0;
      for (const double number : {channel.resolution, channel.noise, channel.bias})
        sensors_.at(what++ * n + i, run) = number;
      sensor_delay_.at(i, run) = static_cast<double>(channel.delay);
      sensor_ticks_ = std::max(sensor_ticks_, static_cast<int>(channel.delay) + 1);
    }
    velocity_share_.at(0, run) = sensors->velocity_share();
    seeds_[run] = experiment.plant.seed;
  }
}

Common Group::common() const {
  const Experiment& experiment = runs_[0]->experiment;
  const Law law = experiment.controller.law;
  Common common{.ticks = plan_.ticks(),
                .start_tick = plan_.start_tick(),
                .rate = experiment.rate_hz,
                .tick_length = 1.0 / experiment.rate_hz,
                .substeps = experiment.plant.substeps,
                .feedforward = takes_mass(law),
                .bias = takes_bias(law),
                .at_desired = experiment.controller.feedforward_at == FeedforwardAt::desired,
                .at_rest = law == Law::pd_gravity,
                .axes = {},
                .differentiated = experiment.plant.sensors.differentiated,
                .runs = static_cast<int>(runs_.size()),
                .settled_within = telling_.settled_within.value_or(-1),
                .references = references_.data()};
  for (const int axis : experiment.scene->end_effector.axes) common.axes[axis] = 1;
  return common;
}

Each Group::each() {
  return {.psi0 = psi0_.data(),
          .kp = kp_.data(),
          .kv = kv_.data(),
          .torque_limit = torque_limit_.data(),
          .error_limit = error_limit_.data(),
          .delay_ticks = delay_ticks_.data(),
          .delay_rest = delay_rest_.data(),
          .plant_constants = constants_[0].data(),
          .mass_constants = constants_[1].data(),
          .bias_constants = constants_[2].data(),
          .hand_constants = constants_[3].data(),
          .drives = drives_.data(),
          .sensors = sensors_.data(),
          .sensor_delay = sensor_delay_.data(),
          .velocity_share = velocity_share_.data(),
          .seeds = seeds_.data()};
}

Told Group::told() {
  const std::size_t runs = runs_.size();
  double* const at = told_.data();
  return {.ticks_recorded = at,
          .most_error = at + runs,
          .most_error_tick = at + 2 * runs,
          .last_error = at + 3 * runs,
          .squares = at + 4 * runs,
          .errors = at + 5 * runs,
          .settled_tick = at + 6 * runs,
          .most_torque = most_torque_.data(),
          .trajectory = telling_.hashes ? trajectory_.data() : nullptr,
          .ring = ring_.data(),
          .ring_ticks = ring_ticks_,
          .sensor_ring = sensor_ring_.data(),
          .sensor_ticks = sensor_ticks_};
}

Measures Group::measures(std::size_t run) {
  const double rate = runs_[run]->experiment.rate_hz;
  const auto told = [&](std::size_t i) { return told_.at(i, run); };
  const auto recorded = static_cast<std::int64_t>(told(0));
  Measures out;
  out.max_position_error = told(1);
  out.time_of_max_position_error = told(2) / rate;
  out.final_position_error = told(3);
  if (told(5) > 0) out.rms_position_error = std::sqrt(told(4) / told(5));
  out.settled_at = told(6) / rate;
  out.max_torque = Vector(n_);
  for (int i = 0; i < n_; ++i) out.max_torque[i] = most_torque_.at(static_cast<std::size_t>(i), run);
  out.ticks = std::max<std::int64_t>(recorded - 1, 0);
  if (recorded <= plan_.ticks()) out.diverged_at = told(0) / rate;
  if (!telling_.hashes || recorded == 0) return out;
  Sha256 hash;
  const auto numbers = static_cast<std::size_t>(3 * n_);
  std::vector<double> row(numbers + 1);
  for (std::size_t k = 0; k < static_cast<std::size_t>(recorded); ++k) {
    row[0] = static_cast<double>(k) / rate;
    for (std::size_t i = 0; i < numbers; ++i) row[i + 1] = trajectory_.at(k * numbers + i, run);
    hash.add(std::span<const double>(row));
  }
  out.trajectory_sha256 = hash.hex();
  return out;
}

/// Whether two runs may lie side by side.
bool are_alike(const PreparedRun& a, const PreparedRun& b) {
  const Experiment &x = a.experiment, &y = b.experiment;
  return a.plan == b.plan && parts_of(x) == parts_of(y) && x.controller.law == y.controller.law &&
         x.controller.feedforward_at == y.controller.feedforward_at && x.plant.substeps == y.plant.substeps &&
         x.rate_hz == y.rate_hz && x.plant.sensors.differentiated == y.plant.sensors.differentiated;
}

}  // namespace

std::string hindrance_in_lanes(const PreparedRun& run) {
  const Experiment& experiment = run.experiment;
  const Scene& scene = *experiment.scene;
  const PlantSettings& plant = experiment.plant;
  const SafetySettings& safety = experiment.controller.safety;
  if (!experiment.has_path() || experiment.path.is_of_motors())
    return "it follows no path of the end effector";
  if (!has_gains(experiment.controller.law)) return "its law has no kp and kv";
  if (plant.continuous) return "its control is continuous";
  if (plant.integrator != Method::rk4 || plant.local_error > 0) return "its integrator is not rk4";
  if (plant.faults.any()) return "something fails, or may";
  if (!plant.sensors.drop.empty()) return "its sensors drop readings";
  if (scene.is_closed() || experiment.controller_scene->is_closed() || plant.partitions)
    return "chains close";
  if (scene.n() != scene.n_u() || experiment.controller_scene->n() != scene.n())
    return "coordinates are free";
  if (scene.end_effector.is_oriented()) return "its end effector's turn is prescribed";
  if (!safety.torque_limit.empty() || !safety.torque_rate_limit.empty() || !safety.velocity_limit.empty() ||
      !safety.position_range.empty())
    return "its controller watches over limits";
  if (experiment.expect.bounds_on("final_psi") || experiment.expect.bounds_on("energy_drift"))
    return "its end or its energy is expected";
  return {};
}

/// Kernels by what they are made of, what can't be compiled among them, and the references of a few plans.
struct LaneEngine::Shelf {
  struct Planned {
    std::shared_ptr<const Plan> plan;
    std::shared_ptr<const std::vector<double>> rows;
  };
  static constexpr std::size_t kMostPlans = 16;

  /// For the processor at hand; nothing where it can't be had.
  struct Compiled {
    SharedObject library;
    std::optional<ClosedLoopKernel> kernel;
  };

  std::mutex mutex;
  std::list<std::pair<KernelParts, Compiled>> kernels;
  std::vector<Planned> planned;

  const ClosedLoopKernel* kernel_of(const KernelParts& parts) {
    const std::lock_guard lock(mutex);
    for (const auto& [known, compiled] : kernels)
      if (known == parts) return compiled.kernel ? &*compiled.kernel : nullptr;
    Compiled& compiled = kernels.emplace_back(parts, Compiled()).second;
    std::string complaint;
    compiled.library = SharedObject::cached(
        parts.key(), [&] { return kernel_source(parts, KernelTarget::processor); }, complaint);
    if (compiled.library)
      compiled.kernel.emplace([&](const std::string& name) { return compiled.library.symbol(name); },
                              lane_width());
    return compiled.kernel ? &*compiled.kernel : nullptr;
  }
  std::shared_ptr<const std::vector<double>> references_of(const std::shared_ptr<const Plan>& plan) {
    const std::lock_guard lock(mutex);
    for (const Planned& known : planned)
      if (known.plan == plan) return known.rows;
    if (planned.size() == kMostPlans) planned.clear();
    planned.push_back({plan, std::make_shared<const std::vector<double>>(rows_of(*plan))});
    return planned.back().rows;
  }
};

std::vector<Outcome> run_in_library(const std::string& library, std::span<const PreparedRun> runs,
                                    const Telling& telling) {
  const std::unique_ptr<void, int (*)(void*)> handle(::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL),
                                                     ::dlclose);
  if (!handle) throw std::runtime_error(::dlerror());
  const ClosedLoopKernel kernel([&](const std::string& name) { return ::dlsym(handle.get(), name.c_str()); },
                                1);
  std::vector<const PreparedRun*> group;
  for (const PreparedRun& run : runs) group.push_back(&run);
  Group gone(group, kernel, rows_of(*runs[0].plan), telling);
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < runs.size(); ++i)
    outcomes.push_back(outcome_of(runs[i], gone.measures(i), telling));
  return outcomes;
}

std::shared_ptr<LaneEngine::Shelf> LaneEngine::make_shelf() { return std::make_shared<Shelf>(); }

std::vector<Outcome> LaneEngine::operator()(std::span<const PreparedRun> runs, const Telling& telling) const {
  std::vector<Outcome> outcomes;
  std::size_t at = 0;
  while (at < runs.size()) {
    std::vector<const PreparedRun*> group;
    if (hindrance_in_lanes(runs[at]).empty())
      for (std::size_t i = at;
           i < runs.size() && hindrance_in_lanes(runs[i]).empty() && are_alike(runs[at], runs[i]); ++i)
        group.push_back(&runs[i]);
    const ClosedLoopKernel* const kernel =
        group.empty() ? nullptr : shelf_->kernel_of(parts_of(runs[at].experiment));
    if (!kernel) {
      const std::size_t alone = std::max<std::size_t>(group.size(), 1);
      for (Outcome& outcome : run_one_by_one(runs.subspan(at, alone), telling))
        outcomes.push_back(std::move(outcome));
      at += alone;
      continue;
    }
    const auto references = shelf_->references_of(runs[at].plan);
    Group gone(group, *kernel, *references, telling);
    for (std::size_t i = 0; i < group.size(); ++i)
      outcomes.push_back(outcome_of(*group[i], gone.measures(i), telling));
    at += group.size();
  }
  return outcomes;
}

}  // namespace mixloop
