// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/experiment.hpp"
#include "loop/measures.hpp"
#include "loop/origin.hpp"
#include "notation/errors.hpp"

namespace mixloop {

/// Exit status of a command, DESIGN: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time, 130
/// interrupted.
enum ExitStatus : int { kHeld = 0, kMissed = 1, kBadInput = 2, kRunFault = 3, kInterrupted = 130 };

/// What became of a run beside what its experiment expects: a divergence that is expected is held.
enum class Verdict : std::uint8_t { held, missed, diverged, safe_state, interrupted, fault };
std::string_view name_of(Verdict verdict);

struct Judgement {
  Verdict verdict = Verdict::held;
  std::vector<std::string> missed;  ///< each bound that was missed, in words
  int exit_status = kHeld;          ///< of `simulate` and `run`: divergence is 3, expected or not
};
Judgement judge(const Experiment& experiment, const Measures& measures);

/// A run of ours: what it was and what was measured of it.
struct RunFigures {
  /// A bound beside what was measured.
  struct Bound {
    Expectation::Bound expected;
    double value = 0;
    bool held = false;
  };
  struct Integrator {
    struct Chosen {
      double local_error = 0, estimate = 0;
      std::string why;
    };
    std::string name;
    std::optional<int> substeps;  ///< one of the two
    std::optional<double> local_error;
    std::optional<Chosen> chosen;  ///< of `integrator: auto`
  };

  Measures measures;
  std::vector<std::string> torque_units;    ///< n_u: N m, of a linear motor N
  std::vector<std::string> position_units;  ///< n: rad, of a linear coordinate m; where there is a final_psi
  std::vector<Bound> bounds;
  bool expects_divergence = false;
  double wall_time = 0;    ///< s
  std::string route;       ///< "simulate", "lockstep", "real_time" or "attached"
  std::string evaluation;  ///< how the plant's equations of motion were evaluated
  double rate = 0;         ///< Hz
  std::string scene, scene_sha256;
  std::map<std::string, double> parameters;  ///< the plant's
  Integrator integrator;
  std::optional<std::uint64_t> seed;  ///< where the run draws random numbers
  Origin origin;
};

/// What the bus added to a run, times in s.
struct BusFigures {
  struct Quantiles {
    double p50 = kNeverMeasured, p99 = kNeverMeasured, p999 = kNeverMeasured, max = kNeverMeasured;
  };
  struct Deadlines {
    std::int64_t longest_miss = 0;
    double success_last_100 = kNeverMeasured;
    std::uint64_t overruns = 0;
    std::optional<std::string> safe_cause, safe_state;
  };

  std::int64_t missed_deadlines = 0;   ///< 0 in lockstep, which waits
  std::optional<Deadlines> deadlines;  ///< in real time
  std::uint64_t resent = 0;
  Quantiles round_trip;
  std::optional<Quantiles> wake_up;  ///< where ticks are paced
  double slipped = 0;
  std::uint64_t rejected = 0;
  std::map<std::string, std::uint64_t> rejected_by_cause;
  std::uint64_t refused_faults = 0;
  std::uint64_t dropped = 0;  ///< datagrams at the plant's socket that the kernel kept from it, or no message
  bool joined_late = false;
};

/// What many runs of an experiment came to.
struct SweepFigures {
  struct Figure {
    std::string name;  ///< e.g. "max_position_error p99.9"
    std::string unit;
    double value = kNeverMeasured;
  };
  std::int64_t runs = 0, done = 0;
  double wall_time = 0;  ///< s
  std::vector<Figure> figures;
};

/// What a command has to tell of an experiment.
struct Result {
  struct Error {
    std::string code, message, where;
  };
  struct Log {
    std::string file;
    std::int64_t events = 0;
    std::int64_t missing_ticks = 0;
  };

  std::string experiment;
  Judgement judged;
  std::optional<RunFigures>
      run;  ///< none: it failed before, or the plant was a stranger's, which told nothing
  std::optional<BusFigures> bus;
  std::optional<SweepFigures> sweep;  ///< in place of a run
  std::optional<std::int64_t> session;
  std::optional<std::int64_t> missing_ticks;  ///< of a run that was listened to
  std::optional<Log> log;
  std::optional<std::map<std::string, std::string>> files;  ///< kept with it: their SHA-256, the log's apart
  std::optional<std::vector<std::string>> warnings;
  std::optional<Error> error;
};

/// A run's result that a fault ended.
Result failed(Result result, const RunFault& fault);

/// The result of a run that is over. `ran`: how the equations were evaluated, whatever was asked for.
Result result_of(const Experiment& experiment, const Measures& measures, const std::string& route,
                 Evaluation ran, double wall_time);

}  // namespace mixloop
