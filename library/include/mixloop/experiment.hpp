// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mixloop/equations.hpp>

namespace mixloop::v1 {

/// What to run with a scene (docs/experiments.md describes its file). Constant: copies share it, threads too.
class MIXLOOP_API Experiment {
 public:
  /// Reads an experiment file and its scene. `sets`: `key=value` as `--set` takes them, e.g. "rate=500 Hz"
  /// or "scene.gravity=[0, 0, 0]". `how` all its equations are evaluated. Throws Error.
  static Experiment load(const std::string& file, const std::vector<std::string>& sets = {},
                         Evaluation how = Evaluation::machine_code);
  /// The same of a text; the scene's path counts from the folder of `file`.
  static Experiment parse(std::string_view text, const std::string& file,
                          const std::vector<std::string>& sets = {},
                          Evaluation how = Evaluation::machine_code);

  const std::string& name() const;  ///< the file's stem
  double rate() const;              ///< Hz: tick k is at k / rate
  Scene scene() const;              ///< the plant's

 private:
  friend struct Inside;
  struct Content;
  explicit Experiment(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/// What is desired at one tick. A view, valid while its plan lives. SI, radians.
struct Reference {
  std::span<const double> psi;              ///< the motors', n_u, rad or m
  std::span<const double> psid;             ///< their rates
  std::span<const double> psidd;            ///< and accelerations
  std::span<const double, 3> position;      ///< the end effector's, inertial axes, m; NaN without a path
  std::span<const double, 3> velocity;      ///< m/s
  std::span<const double, 3> acceleration;  ///< m/s^2
};

/// The references of a whole experiment, worked out and checked before anything moves: a move to the path's
/// start, then the path. Without a path (`duration`) all ticks have one reference: the motors where they
/// start, at rest, or the state that is fed back about. Constant: copies share it, threads too.
class MIXLOOP_API Plan {
 public:
  /// Throws Error where the path can't be followed: where on it, and why.
  explicit Plan(const Experiment& experiment);

  std::int64_t ticks() const;       ///< N, the last tick
  std::int64_t start_tick() const;  ///< where the path begins
  /// At tick k; before 0 as at 0, past N at rest where it ends.
  Reference at(std::int64_t k) const;

 private:
  friend struct Inside;
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace mixloop::v1
