// SPDX-License-Identifier: MIT
#include "planner/plan_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

constexpr double kMostNumbers = 0x1p27;  // of a table: 1 GB

bool timed(const Formula& formula) {
  return depends_on(formula, [](int symbol) { return symbol == Symbols::kTime; });
}

bool constraints_depend_on_time(const Scene& scene) {
  return std::any_of(scene.coordinates.begin(), scene.coordinates.end(), [](const auto& coordinate) { return timed(coordinate.constraint); });
}

bool loads_depend_on_time(const Scene& scene) {
  return std::any_of(scene.loads.begin(), scene.loads.end(), [](const auto& load) {
    return std::any_of(load.force.begin(), load.force.end(), timed) || std::any_of(load.moment.begin(), load.moment.end(), timed);
  });
}

const Plan::Settings& checked(const Plan::Settings& settings, const Model<double>& model) {
  if (!(settings.rate_hz > 0) || !std::isfinite(settings.rate_hz)) throw InputError("out_of_range", {}, fmt::format("a rate of {} Hz; expected more than 0", settings.rate_hz));
  if (settings.stages_per_tick < 1) throw InputError("out_of_range", {}, "fewer than one stage a tick");
  if (!settings.start_psi.empty() && settings.start_psi.size() != static_cast<std::size_t>(model.n()))
    throw InputError("wrong_size", {}, fmt::format("the start has {} values; expected one for each of the {} motors", settings.start_psi.size(), model.n()));
  return settings;
}

/// "crosses the singularity 'flat elbow'" or "comes too near to the singularity 'flat elbow' (4.1e-05 of ...)".
std::string told(const Passage& passage, const std::string& name) {
  if (passage.crosses) return fmt::format("crosses the singularity {}", name);
  return fmt::format("passes through the singularity {}, or too near to it ({:.2g} of its measure at home)", name, passage.value);
}

}  // namespace

PlanMaker::PlanMaker(const Model<double>& model, const Path& path, const Plan::Settings& settings)
    : model_(model), path_(path), settings_(checked(settings, model)), itinerary_(path, settings.rate_hz, settings.stages_per_tick),
      ik_(model), measures_(model, ik_.motor_scale()), timed_(constraints_depend_on_time(*model.scene)), timed_loads_(loads_depend_on_time(*model.scene) && !settings.limits.torque.empty()) {}

void PlanMaker::make(Plan& plan) {
  const LimitCheck limits_are_sound(model_, settings_.limits);
  plan.lap_steps_ = timed_ ? itinerary_.steps() : itinerary_.lap_steps();
  plan.ticks_ = itinerary_.steps() / settings_.stages_per_tick;
  require_room(plan.lap_steps_);
  follow(plan, 0);
  if (!settings_.start_psi.empty()) {
    const Vector from = Eigen::Map<const Vector>(settings_.start_psi.data(), plan.n_);
    const Vector move = reference_in(plan.table_, plan.n_).psi - from;
    if (const std::int64_t ticks = approach_ticks(plan, move); ticks > 0) {
      if (timed_ || timed_loads_) follow(plan, ticks * settings_.stages_per_tick);
      approach(plan, from, ticks);
    }
  }
  rest_past_the_end(plan);
}

void PlanMaker::require_room(std::int64_t steps) const {
  if (static_cast<double>(steps) * static_cast<double>(reference_size(model_.n())) > kMostNumbers)
    throw InputError("too_large", path_.place, fmt::format("{} steps; their table would take more than 1 GB", steps));
}

void PlanMaker::write(Plan& plan, std::int64_t row, const Follower::Motion& motion, double t) {
  const auto n = static_cast<Eigen::Index>(plan.n_);
  PathPoint E = motion.desired;
  const auto& axes = model_.scene->end_effector.axes;
  if (axes.size() < 3) {
    // Where the path doesn't say, the end effector is where the motors bring it.
    const auto& state = ik_.forward(motion.psi, motion.psid, motion.psidd, t);
    for (int i = 0; i < 3; ++i) {
      if (std::find(axes.begin(), axes.end(), i) != axes.end()) continue;
      E.position[i] = state.position[i];
      E.velocity[i] = state.velocity[i];
      E.acceleration[i] = state.acceleration[i];
    }
  }
  Eigen::Map<Vector> out(plan.table_.data() + static_cast<std::size_t>(row) * reference_size(plan.n_), 3 * n + 9);
  out << motion.psi, motion.psid, motion.psidd, E.position, E.velocity, E.acceleration;
}

// The path's rows, one for each step of a lap and one for its end, checked.
void PlanMaker::follow(Plan& plan, std::int64_t delay) {
  const std::int64_t steps = plan.lap_steps_;
  plan.table_.resize(static_cast<std::size_t>(steps + 1) * reference_size(plan.n_));
  samples_.resize(static_cast<std::size_t>(steps + 1) * measures_.count());
  Follower follower(ik_, itinerary_, delay);
  const double t_start = follower.time(0);
  if (const IkOutcome outcome = follower.start([&](const Vector& psi) { return measures_.on_home_branch(psi, t_start); }); outcome != IkOutcome::kSolved)
    refuse_start(outcome, follower.now().psi);
  measures_.adopt_scale(follower.now().psi, t_start);
  for (std::int64_t step = 0; step <= steps; ++step) {
    const auto at = static_cast<double>(step);
    if (const IkOutcome outcome = follower.advance(at); outcome != IkOutcome::kSolved) refuse(outcome, follower, at);
    const double t = follower.time(at);
    write(plan, step, follower.now(), t);
    measures_.evaluate(follower.now().psi, t, samples_.data() + static_cast<std::size_t>(step) * measures_.count());
  }
  check_path(plan, delay);
}

void PlanMaker::check_path(const Plan& plan, std::int64_t delay) {
  Follower follower(ik_, itinerary_, delay);
  const auto row = [&](std::int64_t step) {
    return reference_in(std::span(plan.table_).subspan(static_cast<std::size_t>(step) * reference_size(plan.n_)), plan.n_);
  };
  const auto measures_at = [&](double step, double* values) {
    const std::int64_t before = std::llround(std::floor(step));
    const Reference known = row(before);
    follower.resume({static_cast<double>(before), {}, known.psi, known.psid, known.psidd});
    // Where there is no solution in between, the last place that has one stands for it.
    if (follower.advance(step) != IkOutcome::kSolved) std::fill_n(values, measures_.count(), 0.0);
    else measures_.evaluate(follower.now().psi, follower.time(step), values);
  };
  if (const auto passage = first_passage(samples_, measures_.count(), measures_at)) refuse(*passage, itinerary_.step_rate());

  LimitCheck check(model_, settings_.limits);
  const std::int64_t last = timed_loads_ ? itinerary_.steps() : plan.lap_steps_;
  for (std::int64_t step = 0; step <= last; ++step) check.look(step, row(step == last ? plan.lap_steps_ : step % plan.lap_steps_), follower.time(static_cast<double>(step)));
  if (const auto& worst = check.worst()) {
    const auto at = static_cast<double>(worst->step);
    throw InputError("over_limit", itinerary_.place(at), fmt::format("{:.6g} s into the path, {}, {}", at / itinerary_.step_rate(), itinerary_.describe(at), worst->message));
  }
}

std::int64_t PlanMaker::approach_ticks(const Plan& plan, const Vector& move) const {
  if (move.cwiseAbs().maxCoeff() <= 1e-12 * std::max(1.0, reference_in(plan.table_, plan.n_).psi.cwiseAbs().maxCoeff())) return 0;
  if (path_.approach) return ticks_of(*path_.approach, settings_.rate_hz, path_.place, "the approach");
  const auto& motors = model_.scene->motors;
  Vector fastest = Vector::Zero(plan.n_);
  for (int i = 0; i < plan.n_; ++i) {
    if (!settings_.limits.velocity.empty()) fastest[i] = settings_.limits.velocity[static_cast<std::size_t>(i)];
    for (std::int64_t step = 0; settings_.limits.velocity.empty() && step < plan.lap_steps_; ++step) {
      const double* psid = plan.table_.data() + static_cast<std::size_t>(step) * reference_size(plan.n_) + plan.n_;
      for (int j = 0; j < plan.n_; ++j)
        if (motors[static_cast<std::size_t>(i)].linear == motors[static_cast<std::size_t>(j)].linear) fastest[i] = std::max(fastest[i], std::abs(psid[j]));
    }
  }
  double duration = 1;
  constexpr double kPeak = 15.0 / 8;  // of the quintic's rate over its mean
  for (int i = 0; i < plan.n_; ++i)
    if (fastest[i] > 0) duration = std::max(duration, kPeak * std::abs(move[i]) / fastest[i]);
  return static_cast<std::int64_t>(std::ceil(duration * settings_.rate_hz * (1 - 1e-10)));
}

namespace {

/// A move of the motors from rest to a given motion at its end, of fifth degree in time.
struct Quintic {
  Vector from, c3, c4, c5;
  double duration;

  Quintic(const Vector& from_, const Reference& to, double T) : from(from_), duration(T) {
    const Vector move = to.psi - from, V = T * to.psid, A = T * T * to.psidd;
    c3 = 10 * move - 4 * V + A / 2;
    c4 = -15 * move + 7 * V - A;
    c5 = 6 * move - 3 * V + A / 2;
  }
  Follower::Motion at(double x) const {
    return {0, {}, from + x * x * x * (c3 + x * (c4 + x * c5)), x * x * (3 * c3 + x * (4 * c4 + x * 5 * c5)) / duration,
            x * (6 * c3 + x * (12 * c4 + x * 20 * c5)) / (duration * duration)};
  }
};

}  // namespace

void PlanMaker::approach(Plan& plan, const Vector& from, std::int64_t ticks) {
  const std::int64_t steps = ticks * settings_.stages_per_tick;
  require_room(plan.lap_steps_ + steps);
  const double rate = itinerary_.step_rate();
  const Quintic move(from, reference_in(plan.table_, plan.n_), static_cast<double>(steps) / rate);
  const auto at = [&](double step) { return move.at(step / static_cast<double>(steps)); };
  plan.table_.insert(plan.table_.begin(), static_cast<std::size_t>(steps) * reference_size(plan.n_), 0.0);
  plan.start_tick_ = ticks;
  plan.ticks_ += ticks;

  // In the motors' space the end effector's Jacobian may be singular; what the scene names may not.
  const std::size_t named = measures_.count() - 1;
  std::vector<double> values(measures_.count()), samples;
  LimitCheck check(model_, settings_.limits);
  for (std::int64_t step = 0; step < steps; ++step) {
    const double t = static_cast<double>(step) / rate;
    Follower::Motion motion = at(static_cast<double>(step));
    const auto& state = ik_.forward(motion.psi, motion.psid, motion.psidd, t);
    motion.desired = {state.position, state.velocity, state.acceleration};
    write(plan, step, motion, t);
    check.look(step, plan.at_stage(step / plan.stages_, static_cast<int>(step % plan.stages_)), t);
    measures_.evaluate(motion.psi, t, values.data());
    samples.insert(samples.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(named));
  }
  const auto measures_at = [&](double step, double* out) {
    measures_.evaluate(at(step).psi, step / rate, values.data());
    std::copy_n(values.begin(), named, out);
  };
  if (const auto passage = first_passage(samples, named, measures_at))
    throw InputError(passage->crosses ? "crosses_branch" : "singular_path", path_.place,
                     fmt::format("{:.6g} s into the move to the path's start, which takes {:.6g} s, it {}", passage->step / rate, move.duration, told(*passage, measures_.name(passage->measure))));
  if (const auto& worst = check.worst())
    throw InputError("over_limit", path_.place,
                     fmt::format("{:.6g} s into the move to the path's start, which takes {:.6g} s, {}; give it a longer 'approach'", static_cast<double>(worst->step) / rate, move.duration, worst->message));
}

// The last row once more, without rates.
void PlanMaker::rest_past_the_end(Plan& plan) {
  const std::size_t size = reference_size(plan.n_), last = plan.table_.size() - size;
  plan.table_.resize(last + 2 * size);
  const auto n = static_cast<std::ptrdiff_t>(plan.n_);
  const auto from = plan.table_.begin() + static_cast<std::ptrdiff_t>(last);
  const auto to = from + static_cast<std::ptrdiff_t>(size);
  std::copy_n(from, n, to);
  std::copy_n(from + 3 * n, 3, to + 3 * n);
}

void PlanMaker::refuse_start(IkOutcome outcome, const Vector& nearest) {
  const std::string where = "the path's start, " + itinerary_.describe(0) + ", ";
  if (outcome == IkOutcome::kOtherBranch) throw InputError("crosses_branch", path_.vias[0].place, where + "can be reached only on another branch than home's");
  if (outcome == IkOutcome::kSingular) refuse_singular(0, nearest, 0);
  throw InputError("unreachable", path_.vias[0].place, where + "is out of reach: " + reach_text(0, nearest));
}

std::string PlanMaker::reach_text(double step, Vector psi) {
  const Eigen::Vector3d point = itinerary_.at(step).position;
  if (!ik_.arm()) {
    ik_.position(point, 0, psi);
    return fmt::format("the nearest that a search found is {:.4g} m away", ik_.miss(point, 0, psi));
  }
  const ThreeAxisArm& arm = *ik_.arm();
  const ArmReach reach = reach_of(arm, point);
  if (reach.beside < 0) return fmt::format("{:.6g} m from the base axis; the arm's plane is {:.6g} m from it", point.head<2>().norm(), std::abs(arm.lateral));
  return fmt::format("{:.6g} m from the shoulder axis; the arm reaches from {:.6g} to {:.6g} m", reach.distance, arm.nearest(), arm.farthest());
}

// Which singularity it is: that whose measure is least at the last pose before it.
void PlanMaker::refuse_singular(double step, const Vector& last, double t) {
  std::vector<double> values(measures_.count());
  measures_.evaluate(last, t, values.data());
  const auto least = std::min_element(values.begin(), values.end());
  refuse({step, static_cast<std::size_t>(least - values.begin()), std::max(*least, 0.0), false}, itinerary_.step_rate());
}

double PlanMaker::out_of_reach(double step, Vector psi) {
  const Eigen::Vector3d point = itinerary_.at(step).position;
  if (!ik_.arm()) {
    if (ik_.position(point, 0, psi) == IkOutcome::kSolved) return 0;
    return ik_.miss(point, 0, psi);
  }
  const ThreeAxisArm& arm = *ik_.arm();
  const ArmReach reach = reach_of(arm, point);
  if (reach.beside < 0) return std::abs(arm.lateral) - point.head<2>().norm();
  return std::max({0.0, reach.distance - arm.farthest(), arm.nearest() - reach.distance});
}

// Where the way ends, and how far beyond it the path goes.
void PlanMaker::refuse(IkOutcome outcome, Follower& follower, double step) {
  const double limit = follower.limit(step);
  if (outcome == IkOutcome::kSingular) refuse_singular(limit, follower.now().psi, follower.time(limit));
  double worst = step, most = 0;
  const auto end = static_cast<double>(itinerary_.lap_steps());
  for (int i = 0; i <= 256; ++i) {
    const double at = step + (end - step) * i / 256;
    const double excess = out_of_reach(at, follower.now().psi);
    if (excess <= most) continue;
    most = excess;
    worst = at;
  }
  throw InputError("unreachable", itinerary_.place(limit),
                   fmt::format("{:.6g} s into the path, {}, it leaves what can be reached; {:.6g} s into it, {}, it is {}", limit / itinerary_.step_rate(), itinerary_.describe(limit), worst / itinerary_.step_rate(), itinerary_.describe(worst), reach_text(worst, follower.now().psi)));
}

void PlanMaker::refuse(const Passage& passage, double rate) {
  throw InputError(passage.crosses ? "crosses_branch" : "singular_path", itinerary_.place(passage.step),
                   fmt::format("{:.6g} s into the path, {}, it {}", passage.step / rate, itinerary_.describe(passage.step), told(passage, measures_.name(passage.measure))));
}

}  // namespace mixloop
