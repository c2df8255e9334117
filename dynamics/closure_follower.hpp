// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/program/routine.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// What is watched of a scene's closures at a pose.
struct ClosureWatch {
  double residual = 0;                   ///< the largest of all rows, m or rad
  std::span<const double> conditions{};  ///< of each block, 1 at best (trace_closures)
  /// In a step on the way from the pose before, rad or of the scene's size: times the condition here it is
  /// the largest of all steps' shares of the way to a singular pose.
  double moved = 0;

  /// The block that is nearest to a singular pose.
  std::size_t worst() const {
    return static_cast<std::size_t>(std::max_element(conditions.begin(), conditions.end()) -
                                    conditions.begin());
  }
  /// A singular pose lies within what a step on the way here moved, or round-off.
  bool is_singular() const {
    const double condition = conditions.empty() ? 0 : conditions[worst()];
    return !(condition * std::max(moved, 1e-8) < 0.5);
  }
};

/// Where a scene's closures are solved from, and the solving of those that take corrections: the anchor is
/// the last pose that was accepted, from which all near it are reached. A value: a copy goes on by itself.
class ClosureFollower {
 public:
  ClosureFollower() = default;
  /// `closures`: the routine of trace_closures, which must live on.
  ClosureFollower(std::shared_ptr<const Scene> scene, const Routine& closures);

  explicit operator bool() const { return scene_ != nullptr; }

  /// Starts at home, these parameters (and a factor on friction, last) reached from the scene's defaults.
  void set_parameters(std::span<const double> parameters);

  /// The same where the mechanism stands: the anchor stays.
  void change_parameters(std::span<const double> parameters) noexcept { closures_.set_up(parameters); }

  /// The anchor as numbers: the same numbers, the same solutions from there on.
  std::span<const double> anchor() const { return anchor_; }
  void put_back(std::span<const double> anchor) noexcept;

  /// Where started coordinates are, wound angles and lengths, and how fast, as many each.
  struct Motion {
    std::span<double> at, rate;
  };
  std::size_t started() const { return sizes_.started; }
  /// The anchor stands at a pose that closes, with its started coordinates there.
  void stand(std::span<const double> psi, double t, std::span<const double> at) noexcept;
  /// That of the started coordinates at the anchor, where psi move with psid.
  void look(std::span<const double> psid, const Motion& motion) const noexcept;
  /// The same at a pose near the anchor, which stays. Not finite where it can't be reached.
  Status look_ahead(std::span<const double> psi, std::span<const double> psid, double t,
                    const Motion& motion) noexcept;

  /// Accepts a pose. Status::not_closed, the anchor as it was, where it can't be reached.
  Status accept(std::span<const double> psi, double t) noexcept;
  /// At the last pose that was accepted.
  ClosureWatch watch() const;

  /// A purpose's evaluation that `evaluate` does, of `gives` numbers, its input completed by a start and its
  /// corrections repeated until they are none. Where `follows`, poses that are not near the anchor are
  /// accepted first; where blocks are torn, whose programs give what an anchor takes, the pose is the anchor
  /// from then on.
  Status evaluate(Evaluator& evaluator, const Arguments& at, std::size_t takes, std::span<double> outputs,
                  bool follows) noexcept;

 private:
  struct Sizes {
    std::size_t n, started, start, rows, blocks, corrections, rates;
  };

  Status solve(Evaluator& evaluator, const Arguments& at, std::size_t takes, std::size_t gives) noexcept;
  /// The start for a pose, from the anchor's rates, into input_ from `from` on. How far that went, rad or of
  /// the scene's size.
  double predict(std::span<const double> psi, double t, std::size_t from) noexcept;
  /// The anchor goes to a pose that has been solved.
  void move(const double* solution, const double* rates, std::span<const double> psi, double t) noexcept;
  Status step(std::span<const double> psi, double t) noexcept;
  void read(const double* solution, const double* rates, std::span<const double> psid,
            const Motion& motion) const noexcept;
  /// Of an evaluation that failed: the closures, or what rests on them.
  Status cause_of(Status status, const Arguments& at) noexcept;
  double way_to(std::span<const double> psi, double t) const noexcept;

  std::shared_ptr<const Scene> scene_;
  Evaluator closures_;
  Sizes sizes_{};
  std::vector<double> anchor_;   ///< start, rates by psi and t, psi, t
  std::vector<double> scales_;   ///< of the corrections
  std::vector<double> lengths_;  ///< of the independent coordinates
  std::vector<double> watched_;  ///< what closures_ gave last
  std::vector<double> input_, output_, psi_;
  double moved_ = 0;
};

}  // namespace mixloop
