// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sweep/engine.hpp"

namespace mixloop {

/// A sweep, read and checked: what its runs share, what is told of them, and what it expects.
class Sweep {
 public:
  struct Bound {
    double share = 1;  ///< of the runs, at least
    Expectation expected;
    Place place;
  };
  /// What makes a sweep this one: in the order of its file.
  using Settings = std::vector<std::pair<std::string, std::string>>;

  /// `name`: of its file, or of the experiment. Throws InputError; also where none of a few runs looked at
  /// can be run, as a value of the wrong kind makes all of them.
  Sweep(std::string name, const SweepRequest& request, Evaluation evaluation, bool hashes);

  const std::string& name() const { return name_; }
  std::int64_t runs() const { return setup_.design().runs(); }
  const Setup& setup() const { return setup_; }
  const Telling& telling() const { return telling_; }
  const std::vector<Bound>& bounds() const { return bounds_; }
  const Settings& settings() const { return settings_; }
  /// The hash of its settings: equal for sweeps whose tables are equal.
  const std::string& sha256() const { return sha256_; }

  /// The command that goes through a run alone.
  std::string command(std::int64_t run) const;

 private:
  void require_some_run() const;

  std::string name_;
  Setup setup_;
  Telling telling_;
  std::vector<Bound> bounds_;
  Settings settings_;
  std::string sha256_;
};

}  // namespace mixloop
