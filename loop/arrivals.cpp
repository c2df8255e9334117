// SPDX-License-Identifier: MIT
#include "loop/arrivals.hpp"

#include "loop/measured_state.hpp"
#include "loop/simulate.hpp"

namespace mixloop {
namespace {

/// The controller of a run in real time: what it commanded at a tick, from what it had there.
class Commands {
 public:
  Commands(const Experiment& experiment, const Plan& plan, const std::vector<Arrival>& arrivals)
      : plan_(plan),
        rate_hz_(experiment.rate_hz),
        n_u_(static_cast<std::size_t>(plan.n_u())),
        controller_(make_guarded_controller(experiment)),
        later_(plan.n_u()),
        torques_(static_cast<std::size_t>(plan.ticks() + 1) * n_u_),
        next_(arrivals.begin()),
        end_(arrivals.end()) {}

  GuardedController& controller() { return controller_; }
  std::span<double> at(std::int64_t k) {
    return std::span(torques_).subspan(static_cast<std::size_t>(k) * n_u_, n_u_);
  }

  /// Ticks in their order. A state that was never answered did nothing: limits that remember know none of it.
  void compute(std::int64_t k, const MeasuredState& state) {
    while (next_ != end_ && next_->command < k) ++next_;
    if (next_ == end_ || next_->command != k) return;
    if (next_->ahead != Arrival::kBlind) go_by_law(k, next_->ahead, state);
    if (next_->ahead == Arrival::kBlind || next_->afterwards) controller_.safe_torque(at(k));
  }

 private:
  void go_by_law(std::int64_t k, std::int64_t ahead, const MeasuredState& state) {
    const Reference reference =
        ahead == 0 ? plan_.at(k) : later_.take(plan_.at(k - ahead), static_cast<double>(ahead) / rate_hz_);
    const double t = static_cast<double>(k) / rate_hz_;
    controller_.torque({state.psi(), state.psid(), t, state.stale()}, reference, at(k));
  }

  const Plan& plan_;
  double rate_hz_;
  std::size_t n_u_;
  GuardedController controller_;
  ExtrapolatedReference later_;
  std::vector<double> torques_;
  std::vector<Arrival>::const_iterator next_, end_;
};

}  // namespace

void simulate_arrivals(const Experiment& experiment, const Plan& plan, const Arrivals& arrivals,
                       Recorder& recorder, const std::function<bool(std::int64_t k)>& go_on) {
  DeadlinePlant hardware = make_deadline_plant(experiment, plan);
  Plant& plant = hardware.plant();
  MeasuredState measured(plant);
  Commands commands(experiment, plan, arrivals.commands);
  require_start(commands.controller(), plant.psi(), plan);
  auto next = arrivals.commands.begin();
  auto event = arrivals.interventions.begin();

  if (!recorder.state(0, plant.psi(), plant.psid(), plant.work())) return;
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    if (!go_on(k)) return recorder.interrupted();
    measured.take(plant);
    commands.compute(k, measured);
    const bool was_safe = hardware.safe().has_value();
    for (; event != arrivals.interventions.end() && event->tick <= k; ++event)
      event->cause != nullptr ? hardware.make_safe(event->cause) : void(hardware.inject(event->fault));
    recorder.note_changes(k, plant.faults());
    for (; next != arrivals.commands.end() && next->tick == k; ++next)
      hardware.command(*next, commands.at(next->command));
    const bool is_safe = hardware.safe().has_value();
    if (!was_safe && is_safe) recorder.made_safe(k);
    hardware.finish_tick();
    if (!is_safe && hardware.safe()) recorder.made_safe(k + 1);
    if (!recorder.command(k, hardware.commanded(), plant.applied())) return;
    if (k < plan.ticks() && !recorder.state(k + 1, plant.psi(), plant.psid(), plant.work())) return;
  }
}

}  // namespace mixloop
