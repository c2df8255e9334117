// SPDX-License-Identifier: MIT
#include "sweep/kernel/closed_loops.hpp"

#include <dlfcn.h>

#include <atomic>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "dynamics/program/compiler.hpp"
#include "dynamics/program/processor.hpp"
#include "dynamics/program/shared_object.hpp"
#include "plant/hardware.hpp"
#include "sweep/kernel/loop_group.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kOnDevice = 4096;  // runs at a time, of each thread that prepares some
constexpr std::size_t kCompared = 8;      // of them, the first time

std::vector<Outcome> gone_through(std::span<const PreparedRun* const> runs, const LoopKernel& kernel,
                                  const std::vector<double>& references, const Telling& telling) {
  LoopGroup group(runs, kernel, references, telling);
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < runs.size(); ++i)
    outcomes.push_back(outcome_of(*runs[i], group.measures(i), telling));
  return outcomes;
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

std::string hindrance_on_device(const PreparedRun& run) {
  if (std::string why = hindrance_in_lanes(run); !why.empty()) return why;
  if (Hardware::needed(run.experiment.plant)) return "its drives or sensors are not ideal";
  return {};
}

/// Kernels by what they are made of, what can't be compiled among them, and the references of a few plans.
class LaneEngine::Shelf {
 public:
  struct Compiled {
    KernelParts parts;
    LoopDevice device = LoopDevice::cpu;
    SharedObject library;
    std::optional<LoopKernel> kernel;  ///< nothing where it can't be had
    std::string complaint;
    std::atomic<bool> is_compared{false};
  };

  explicit Shelf(LoopDevice device) : device_(device) {}

  LoopDevice device() const { return device_; }
  Compiled& kernel_of(const KernelParts& parts, LoopDevice device) {
    const std::lock_guard lock(mutex_);
    for (Compiled& known : kernels_)
      if (known.parts == parts && known.device == device) return known;
    Compiled& compiled = kernels_.emplace_back();
    compiled.parts = parts;
    compiled.device = device;
    compile(compiled);
    return compiled;
  }
  std::shared_ptr<const std::vector<double>> references(const std::shared_ptr<const Plan>& plan) {
    const std::lock_guard lock(mutex_);
    for (const Planned& known : planned_)
      if (known.plan == plan) return known.rows;
    if (planned_.size() == kMostPlans) planned_.clear();
    planned_.push_back({plan, std::make_shared<const std::vector<double>>(references_of(*plan))});
    return planned_.back().rows;
  }

 private:
  struct Planned {
    std::shared_ptr<const Plan> plan;
    std::shared_ptr<const std::vector<double>> rows;
  };
  static constexpr std::size_t kMostPlans = 16;

  static void compile(Compiled& compiled) {
    const KernelParts& parts = compiled.parts;
    const bool on_device = compiled.device == LoopDevice::cuda;
    const auto source = [&] {
      return kernel_source(parts, on_device ? KernelTarget::cuda : KernelTarget::processor);
    };
    if (!on_device) {
      compiled.library = SharedObject::cached(parts.key(), source, compiled.complaint);
    } else if (const auto compiler = find_cuda_compiler()) {
      compiled.library = SharedObject::cached(parts.key(), source, *compiler, compiled.complaint);
    } else {
      compiled.complaint = "there is no nvcc (on the PATH, or $MIXLOOP_NVCC)";
    }
    if (compiled.library)
      compiled.kernel.emplace([&](const std::string& name) { return compiled.library.symbol(name); },
                              on_device ? 0 : lane_width());
  }

  LoopDevice device_;
  std::mutex mutex_;
  std::list<Compiled> kernels_;
  std::vector<Planned> planned_;
};

std::vector<Outcome> run_in_library(const std::string& library, std::span<const PreparedRun> runs,
                                    const Telling& telling) {
  const std::unique_ptr<void, int (*)(void*)> handle(::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL),
                                                     ::dlclose);
  if (!handle) throw std::runtime_error(::dlerror());
  const LoopKernel kernel([&](const std::string& name) { return ::dlsym(handle.get(), name.c_str()); }, 1);
  std::vector<const PreparedRun*> group;
  for (const PreparedRun& run : runs) group.push_back(&run);
  return gone_through(group, kernel, references_of(*runs[0].plan), telling);
}

LaneEngine::LaneEngine(LoopDevice device) : shelf_(std::make_shared<Shelf>(device)) {}

std::int64_t LaneEngine::batch() const { return shelf_->device() == LoopDevice::cuda ? kOnDevice : 1; }

std::vector<Outcome> LaneEngine::operator()(std::span<const PreparedRun> runs, const Telling& telling) const {
  std::vector<Outcome> outcomes;
  const auto add = [&](std::vector<Outcome> more) { std::ranges::move(more, std::back_inserter(outcomes)); };
  const auto device_of = [&](const PreparedRun& run) {
    const bool may = shelf_->device() == LoopDevice::cuda && hindrance_on_device(run).empty();
    return may ? LoopDevice::cuda : LoopDevice::cpu;
  };
  while (outcomes.size() < runs.size()) {
    const std::size_t at = outcomes.size();
    std::vector<const PreparedRun*> group;
    for (std::size_t i = at;
         i < runs.size() && hindrance_in_lanes(runs[i]).empty() && (i == at || are_alike(runs[at], runs[i]));
         ++i)
      group.push_back(&runs[i]);
    if (group.empty()) {
      add(run_one_by_one(runs.subspan(at, 1), telling));
      continue;
    }
    const LoopDevice device = device_of(runs[at]);
    Shelf::Compiled& compiled = shelf_->kernel_of(parts_of(runs[at].experiment), device);
    const auto these = runs.subspan(at, group.size());
    if (!compiled.kernel && device == LoopDevice::cuda)
      throw RunFault("missing_part", "--device cuda: " + compiled.complaint);
    if (!compiled.kernel) {
      add(run_one_by_one(these, telling));
      continue;
    }
    auto gone = gone_through(group, *compiled.kernel, *shelf_->references(runs[at].plan), telling);
    if (device == LoopDevice::cuda && !compiled.is_compared.exchange(true)) {
      const std::size_t some = std::min(kCompared, these.size());
      const auto here = run_one_by_one(these.first(some), telling);
      if (!std::ranges::equal(here, std::span(gone).first(some), are_same))
        throw RunFault("other_bits",
                       "the graphics processor's first runs have other bits than this processor's; "
                       "expected --device cpu, and a report of device, driver and nvcc");
    }
    add(std::move(gone));
  }
  return outcomes;
}

}  // namespace mixloop
