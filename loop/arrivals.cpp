// SPDX-License-Identifier: MIT
#include "loop/arrivals.hpp"

#include "loop/simulate.hpp"

namespace mixloop {
namespace {

/// The controller of a run in real time: what it commanded at a tick, from what it had there.
class Commands {
 public:
  Commands(const Experiment& experiment, const Plan& plan, const std::vector<Arrival>& arrivals)
      : plan_(plan),
        rate_hz_(experiment.rate_hz),
        n_(static_cast<std::size_t>(plan.n())),
        controller_(make_guarded_controller(experiment)),
        later_(plan.n()),
        torques_(static_cast<std::size_t>(plan.ticks() + 1) * n_),
        next_(arrivals.begin()),
        end_(arrivals.end()) {}

  GuardedController& controller() { return controller_; }
  std::span<double> at(std::int64_t k) {
    return std::span(torques_).subspan(static_cast<std::size_t>(k) * n_, n_);
  }

  /// Ticks in their order. A state that was never answered did nothing: limits that remember know none of it.
  void compute(std::int64_t k, const RecordedPlant::Measured& state) {
    while (next_ != end_ && next_->command < k) ++next_;
    if (next_ == end_ || next_->command != k) return;
    if (next_->ahead != Arrival::kBlind) go_by_law(k, next_->ahead, state);
    if (next_->ahead == Arrival::kBlind || next_->afterwards) controller_.safe_torque(at(k));
  }

 private:
  void go_by_law(std::int64_t k, std::int64_t ahead, const RecordedPlant::Measured& state) {
    const Reference reference =
        ahead == 0 ? plan_.at(k) : later_.take(plan_.at(k - ahead), static_cast<double>(ahead) / rate_hz_);
    const double t = static_cast<double>(k) / rate_hz_;
    controller_.torque(state.psi, state.psid, state.stale, reference, t, at(k));
  }

  const Plan& plan_;
  double rate_hz_;
  std::size_t n_;
  GuardedController controller_;
  ExtrapolatedReference later_;
  std::vector<double> torques_;
  std::vector<Arrival>::const_iterator next_, end_;
};

}  // namespace

void simulate_arrivals(RecordedPlant& run, const Arrivals& arrivals,
                       const std::function<bool(std::int64_t k)>& go_on) {
  const Plan& plan = run.plan();
  Commands commands(run.experiment(), plan, arrivals.commands);
  require_start(commands.controller(), run.plant().psi(), plan);
  auto next = arrivals.commands.begin();
  auto event = arrivals.interventions.begin();
  std::vector<Fault> faults;
  const auto before_end = [&](std::int64_t k) { return k < plan.ticks(); };

  if (!run.begin()) return;
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    if (!go_on(k)) return run.recorder().interrupted();
    commands.compute(k, run.measure());
    faults.clear();
    for (; event != arrivals.interventions.end() && event->tick <= k; ++event)
      event->cause != nullptr ? run.make_safe(event->cause) : faults.push_back(event->fault);
    for (; next != arrivals.commands.end() && next->tick == k; ++next)
      run.command(*next, commands.at(next->command));
    if (!run.real_time_tick(faults, before_end)) return;
  }
}

}  // namespace mixloop
