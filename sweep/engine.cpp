// SPDX-License-Identifier: MIT
#include "sweep/engine.hpp"

#include "loop/simulate.hpp"

namespace mixloop {
namespace {

RunEnd end_of(const Judgement& judgement, const Measures& measures) {
  if (measures.diverged_at && !judgement.missed.empty()) return RunEnd::diverged;
  if (measures.safe_at && !judgement.missed.empty()) return RunEnd::safe_state;
  return judgement.missed.empty() ? RunEnd::held : RunEnd::missed;
}

/// Of a run that was never gone through, or not to its end.
Outcome failure(std::int64_t run, RunEnd end, const std::string& code, const Telling& telling) {
  return {.run = run,
          .end = end,
          .code = code,
          .values = std::vector<double>(telling.columns.size(), kNeverMeasured)};
}

Outcome gone_through(const PreparedRun& run, const Telling& telling) {
  RecordedPlant plant(run.experiment, *run.plan,
                      {.keeps_ticks = telling.hashes, .settled_within = telling.settled_within});
  simulate(plant, [](std::int64_t) { return true; });
  return outcome_of(run, plant.recorder().measures(), telling);
}

}  // namespace

Outcome outcome_of(const PreparedRun& run, const Measures& measures, const Telling& telling) {
  const Judgement judgement = judge(run.experiment, measures);
  return {.run = run.run,
          .end = end_of(judgement, measures),
          .values = telling.columns.values(measures),
          .sha256 = measures.trajectory_sha256};
}

std::vector<Outcome> run_one_by_one(std::span<const PreparedRun> runs, const Telling& telling) {
  std::vector<Outcome> outcomes;
  for (const PreparedRun& run : runs) try {
      outcomes.push_back(gone_through(run, telling));
    } catch (const RunFault& fault) {
      outcomes.push_back(failure(run.run, RunEnd::fault, fault.code, telling));
    } catch (const InputError& error) {
      outcomes.push_back(failure(run.run, RunEnd::refused, error.code, telling));
    }
  return outcomes;
}

std::vector<Outcome> run_batch(const Setup& setup, const Telling& telling, const Engine& engine,
                               std::int64_t first, std::int64_t count, const std::function<bool()>& goes_on) {
  return run_batch([&](std::int64_t run) { return setup.prepared(run); }, telling, engine, first, count,
                   goes_on);
}

std::vector<Outcome> run_batch(const Prepare& prepare, const Telling& telling, const Engine& engine,
                               std::int64_t first, std::int64_t count, const std::function<bool()>& goes_on) {
  const std::int64_t together = std::max(Engine::kTogether, engine.batch());
  std::vector<Outcome> outcomes;
  for (std::int64_t begin = first; begin < first + count; begin += together) {
    if (begin > first && !goes_on()) break;
    const std::int64_t end = std::min(begin + together, first + count);
    std::vector<PreparedRun> ready;
    std::vector<Outcome> refused;
    for (std::int64_t run = begin; run < end; ++run) try {
        ready.push_back(prepare(run));
      } catch (const InputError& error) {
        refused.push_back(failure(run, RunEnd::refused, error.code, telling));
      }
    auto ran = engine(ready, telling);
    auto next = ran.begin(), other = refused.begin();
    for (std::int64_t run = begin; run < end; ++run)
      outcomes.push_back(std::move(other != refused.end() && other->run == run ? *other++ : *next++));
  }
  return outcomes;
}

}  // namespace mixloop
