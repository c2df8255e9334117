// SPDX-License-Identifier: MIT
#include "loop/simulate.hpp"

#include "library/inside.hpp"
#include "loop/result.hpp"

namespace mixloop::v1 {
namespace {

/// The result of a run that `drive` has driven to its end.
template <class Drive>
Result driven(const Experiment& experiment, const Drive& drive) {
  return inside::translated([&] {
    const mixloop::Plan plan = make_plan(Inside::of(experiment));
    const mixloop::Experiment settled = with_integrator_settled(Inside::of(experiment), plan);
    RecordedPlant run(settled, plan);
    drive(run);
    const Recorder& recorder = run.recorder();
    const Measures measures = recorder.measures();
    const Judgement judged = judge(settled, measures);
    Result result{.verdict = std::string(name_of(judged.verdict)),
                  .missed = judged.missed,
                  .max_position_error = measures.max_position_error,
                  .time_of_max_position_error = measures.time_of_max_position_error,
                  .final_position_error = measures.final_position_error,
                  .rms_position_error = measures.rms_position_error,
                  .max_torque = {measures.max_torque.begin(), measures.max_torque.end()},
                  .diverged_at = measures.diverged_at,
                  .trajectory_sha256 = measures.trajectory_sha256,
                  .ticks = measures.ticks};
    const auto append = [](std::vector<double>& to, std::span<const double> row) {
      to.insert(to.end(), row.begin(), row.end());
    };
    for (std::int64_t k = 0; k < recorder.ticks_recorded(); ++k) {
      append(result.psi, recorder.psi(k));
      append(result.psid, recorder.psid(k));
      append(result.tau, recorder.commanded(k));
    }
    result.energy_drift = measures.energy_drift;
    return result;
  });
}

bool always(std::int64_t) { return true; }

}  // namespace

Result simulate(const Experiment& experiment) {
  return driven(experiment, [](RecordedPlant& run) { mixloop::simulate(run, always); });
}

Result simulate(const Experiment& experiment,
                const std::function<void(const State&, const Reference&, std::span<double>)>& law) {
  return driven(experiment, [&](RecordedPlant& run) {
    const auto torque = [&](const Measurement& now, const mixloop::Reference& desired,
                            std::span<double> tau) {
      law({now.psi, now.psid, now.t}, inside::seen(desired), tau);
    };
    mixloop::simulate(run, torque, always);
  });
}

}  // namespace mixloop::v1
