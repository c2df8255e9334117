// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/assembly/partitions.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/loop_motion.hpp"

namespace mixloop {

/// A mechanism's equations of motion in each of its partitions, with a workspace of each. One thread at a
/// time uses it; a copy is another. Nothing allocates after construction.
class Partitions {
 public:
  using List = std::shared_ptr<const std::vector<Partition>>;

  /// Throws InputError("too_large") where a partition takes more operations than a program may: the procedure
  /// itself can't be put on a branch.
  Partitions(List partitions, Evaluation how, std::initializer_list<Purpose> purposes,
             Equations::Options options, std::span<const double> parameters);

  int size() const { return static_cast<int>(dynamics_.size()); }
  const Scene& declared() const { return *list_->front().scene; }
  /// Of a caller that has the workspace in use, at first of the declared partition: it becomes another
  /// partition's, that it was goes back.
  void exchange(Equations::Workspace& in_use, int partition) noexcept;
  void set_parameters(std::span<const double> parameters, double friction) noexcept;

  std::size_t longest_anchor() const;
  /// Room for one.
  LoopMotion motion() const;
  /// psi and psi', n each, as declared.
  std::span<const double> psi(const LoopMotion& motion) const { return span_of(motion.at).last(n_); }
  std::span<const double> psid(const LoopMotion& motion) const { return span_of(motion.rate).last(n_); }
  /// The coordinates that are independent in a partition, and their rates, n each.
  void independent(int partition, const LoopMotion& motion, std::span<double> z,
                   std::span<double> zd) const noexcept;

  /// That where z move with zd in the partition that is in use, whose closures have accepted z.
  void look(const ClosureFollower& closures, std::span<const double> z, std::span<const double> zd,
            LoopMotion& motion) noexcept;
  /// The same near the pose that was accepted. Not finite where it can't be reached.
  void look_ahead(ClosureFollower& closures, std::span<const double> z, std::span<const double> zd, double t,
                  LoopMotion& motion) noexcept;

  /// Puts the closures of a partition where the motion is. The condition of its worst block there; HUGE_VAL
  /// where it doesn't get there.
  double stand(int partition, const LoopMotion& motion, double t) noexcept;
  /// A purpose's evaluation in the motion's own partition.
  Status evaluate(Purpose purpose, const LoopMotion& motion, std::span<const double> input, double t,
                  std::span<double> outputs) noexcept;

 private:
  /// Where in a LoopMotion a partition's coordinates stand.
  struct Places {
    std::vector<std::size_t> independent, started;
  };
  Equations::Workspace& dynamics(int partition) {
    return dynamics_[static_cast<std::size_t>(partition == 0 ? in_use_ : partition)];
  }
  void gather(int partition, std::span<const double> z, std::span<const double> zd, LoopMotion& motion) const;
  ClosureFollower::Motion hand() { return {span_of(at_), span_of(rate_)}; }

  List list_;
  std::size_t n_;
  std::vector<Places> places_;
  std::vector<Equations::Workspace> dynamics_;  ///< in place of a caller's that of the declared one
  int in_use_ = 0;                              ///< by a caller
  Vector at_, rate_, z_, zd_;
};

}  // namespace mixloop
