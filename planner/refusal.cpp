// SPDX-License-Identifier: MIT
#include "planner/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

constexpr double kTouching = 1e-9;  // of the mechanism's size: what is nearer than that is reached

constexpr const char* kNotClosed =
    "the mechanism's closures can't be closed: it has no pose with its motors there";

}  // namespace

std::string Refusal::where(double step) const {
  return fmt::format("{:.6g} s into the path, {}, ", step / itinerary_.step_rate(),
                     itinerary_.describe(step));
}

std::string Refusal::where_before(double step, double duration) const {
  return fmt::format("{:.6g} s into the move to the path's start, which takes {:.6g} s, ",
                     step / itinerary_.step_rate(), duration);
}

std::string Refusal::text(const Passage& passage) const {
  const std::string name = measures_.name(passage.measure);
  if (passage.crosses) return "it crosses the singularity " + name;
  return fmt::format(
      "it passes through the singularity {}, or too near to it ({:.2g} of its measure at home)", name,
      passage.value);
}

void Refusal::passage(const Passage& passage, const std::string& lost) const {
  throw InputError(passage.crosses ? "crosses_branch" : "singular_path", itinerary_.place(passage.step),
                   where(passage.step) + text(passage) + lost);
}

void Refusal::excess(const Excess& excess) const {
  const auto step = static_cast<double>(excess.step);
  throw InputError("over_limit", itinerary_.place(step), where(step) + excess.message);
}

void Refusal::jump(double step, const std::string& jumped) const {
  throw InputError("angle_jumps", itinerary_.place(step), where(step) + jumped);
}

void Refusal::jump_before(double step, const std::string& jumped, double duration) const {
  throw InputError("angle_jumps", path_.place, where_before(step, duration) + jumped);
}

void Refusal::passage_before(const Passage& passage, double duration) const {
  throw InputError(passage.crosses ? "crosses_branch" : "singular_path", path_.place,
                   where_before(passage.step, duration) + text(passage));
}

void Refusal::excess_before(const Excess& excess, double duration) const {
  throw InputError("over_limit", path_.place,
                   where_before(static_cast<double>(excess.step), duration) + excess.message +
                       "; a longer 'approach' is gentler");
}

// Which singularity it is: that whose measure is least at the last pose before it.
void Refusal::singular(double step, const Vector& last, double t) const {
  std::vector<double> values(measures_.count());
  measures_.evaluate(last, t, values.data());
  const auto least = std::min_element(values.begin(), values.end());
  const auto measure = static_cast<std::size_t>(least - values.begin());
  passage({step, measure, std::max(*least, 0.0), false}, measures_.lost(measure, last, t));
}

void Refusal::not_closed(double step) const {
  throw InputError("unreachable", itinerary_.place(step), where(step) + kNotClosed);
}

void Refusal::not_closed_before(double step, double duration) const {
  throw InputError("unreachable", path_.place, where_before(step, duration) + kNotClosed);
}

void Refusal::no_start(IkOutcome outcome, const Vector& nearest, double t) const {
  if (!ik_) not_closed(0);
  const std::string start = "the path's start, " + itinerary_.describe(0) + ", ";
  if (outcome == IkOutcome::other_branch)
    throw InputError("crosses_branch", path_.vias[0].place,
                     start + "can be reached only on another branch than home's");
  if (outcome == IkOutcome::singular || out_of_reach(0, t, nearest) <= kTouching * ik_->scale())
    singular(0, nearest, t);
  throw InputError("unreachable", path_.vias[0].place,
                   start + "is out of reach: " + reach_text(0, t, nearest));
}

void Refusal::no_way(Follower& follower, double step) const {
  const double end = follower.limit(step);
  if (!ik_) not_closed(end);
  const Vector last = follower.now().motors.psi;
  double farthest = step, most = 0;
  for (int i = 0; i <= 256; ++i) {
    const double at = step + (static_cast<double>(itinerary_.lap_steps()) - step) * i / 256;
    const double excess = out_of_reach(at, follower.time(at), last);
    if (!(excess > most)) continue;  // not finite where closures end on the way
    most = excess;
    farthest = at;
  }
  // Where all of it can be reached, it is the way there that the motors don't find.
  if (most <= kTouching * ik_->scale()) singular(end, last, follower.time(end));
  throw InputError("unreachable", itinerary_.place(end),
                   where(end) + "it leaves what can be reached; " + where(farthest) + "it is " +
                       reach_text(farthest, follower.time(farthest), last));
}

/// How far the point of a step is out of reach, m; 0 within it. `nearby`: motors to start a search from.
double Refusal::out_of_reach(double step, double t, Vector nearby) const {
  const PathPoint point = itinerary_.at(step);
  if (!ik_->arm())
    return ik_->position(point, t, nearby) == IkOutcome::solved ? 0 : ik_->miss(point, t, nearby);
  const ThreeAxisArm& arm = *ik_->arm();
  const ArmReach reach = reach_of(arm, point.position);
  if (reach.beside < 0) return std::abs(arm.lateral) - point.position.head<2>().norm();
  return std::max({0.0, reach.distance - arm.farthest(), arm.nearest() - reach.distance});
}

std::string Refusal::reach_text(double step, double t, Vector nearby) const {
  const PathPoint point = itinerary_.at(step);
  if (!ik_->arm()) {
    ik_->position(point, t, nearby);
    const auto [error, jacobian, rate, place, angle] = ik_->prescription().miss(point, t, nearby);
    return fmt::format("{:.4g} m{} from the nearest place that a search found", place,
                       angle > 0 ? fmt::format(" and {:.4g} rad", angle) : "");
  }
  const ThreeAxisArm& arm = *ik_->arm();
  const ArmReach reach = reach_of(arm, point.position);
  if (reach.beside < 0)
    return fmt::format("{:.6g} m from the base axis; the arm's plane is {:.6g} m from it",
                       point.position.head<2>().norm(), std::abs(arm.lateral));
  return fmt::format("{:.6g} m from the shoulder axis; the arm reaches from {:.6g} to {:.6g} m",
                     reach.distance, arm.nearest(), arm.farthest());
}

}  // namespace mixloop
