// SPDX-License-Identifier: MIT
#include "planner/plan_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "dynamics/scene/time_dependence.hpp"
#include "notation/long_work.hpp"
#include "planner/move_to_start.hpp"

namespace mixloop {
namespace {

constexpr double kMostNumbers = 0x1p27;  // of a table: 1 GB
constexpr const char* kWork = "planning the path";

const Plan::Settings& checked(const Plan::Settings& settings, const Model<double>& model) {
  if (!(settings.rate_hz > 0) || !std::isfinite(settings.rate_hz))
    throw InputError("out_of_range", {},
                     fmt::format("a rate of {} Hz; expected more than 0", settings.rate_hz));
  if (settings.stages_per_tick < 1) throw InputError("out_of_range", {}, "fewer than one stage a tick");
  if (settings.within.empty() || settings.within.front() != 0 || settings.within.back() >= 1 ||
      !std::is_sorted(settings.within.begin(), settings.within.end()))
    throw InputError("out_of_range", {}, "a step's rows are to ascend from 0 and to stay below 1");
  if (const std::size_t n_u = model.scene->motors().size();
      !settings.start_psi.empty() && settings.start_psi.size() != n_u)
    throw InputError("wrong_size", {},
                     fmt::format("the start has {} values; expected one for each of the {} motors",
                                 settings.start_psi.size(), n_u));
  return settings;
}

/// Of a path of the end effector. What the motors can't settle is said where the path stands.
std::unique_ptr<InverseKinematics> inverse_of(const Model<double>& model, const Path& path) {
  if (path.is_of_motors()) return nullptr;
  try {
    return std::make_unique<InverseKinematics>(model, InverseKinematics::Method::closed_form_if_known,
                                               InverseKinematics::Redundancy{path.held, path.least_norm});
  } catch (const InputError& error) {
    throw error.code == "no_inverse" ? InputError(error.code, path.place, error.message) : error;
  }
}

}  // namespace

PlanMaker::PlanMaker(const Model<double>& model, const Path& path, const Plan::Settings& settings)
    : model_(model),
      hand_(model),
      path_(oriented(path, hand_)),
      settings_(checked(settings, model)),
      width_(static_cast<std::int64_t>(settings.within.size())),
      itinerary_(path_, settings.rate_hz, settings.stages_per_tick),
      ik_(inverse_of(model, path_)),
      measures_(model, hand_.motor_scale(), ik_ ? std::optional(path_.held) : std::nullopt),
      refusal_(path_, itinerary_, ik(), measures_),
      timed_(constraints_depend_on_time(*model.scene)),
      timed_loads_(loads_depend_on_time(*model.scene) && !settings.limits.torque.empty()) {}

void PlanMaker::make(Plan& plan) {
  const LimitCheck limits_are_sound(model_, settings_.limits);
  lap_steps_ = timed_ ? itinerary_.steps() : itinerary_.lap_steps();
  plan.lap_rows_ = lap_steps_ * width_;
  plan.ticks_ = itinerary_.steps() / settings_.stages_per_tick;
  require_room(static_cast<double>(lap_steps_));
  follow(plan, 0);
  if (!settings_.start_psi.empty()) {
    const Vector from = Eigen::Map<const Vector>(settings_.start_psi.data(), plan.n_u_);
    const Vector move = reference_in(plan.table_, plan.n_u_).psi - from;
    if (const std::int64_t ticks = approach_ticks(plan, move); ticks > 0) {
      if (timed_ || timed_loads_) follow(plan, ticks * settings_.stages_per_tick);
      approach(plan, from, ticks);
    }
  }
  rest_past_the_end(plan);
}

void PlanMaker::require_room(double steps) const {
  if (!(steps * static_cast<double>(width_) * static_cast<double>(reference_size(model_.n_u())) <=
        kMostNumbers))
    throw InputError("too_large", path_.place,
                     fmt::format("{} steps; their table would take more than 1 GB", steps));
}

std::span<double> PlanMaker::row(Plan& plan, std::int64_t index) const {
  const std::size_t size = reference_size(plan.n_u_);
  return std::span(plan.table_).subspan(static_cast<std::size_t>(index) * size, size);
}

// Of the end effector, the path's own numbers on the scene's axes, and where the motors bring it on the
// others.
void PlanMaker::write(const Follower::Motion& motion, double t, std::span<double> row) {
  const auto& [psi, psid, psidd] = motion.motors;
  PathPoint E = motion.desired;
  const auto& [axes, is_named] = std::tie(model_.scene->end_effector.axes, model_.scene->end_effector.named);
  if (!is_named) {
    for (Eigen::Vector3d* nowhere : {&E.position, &E.velocity, &E.acceleration})
      nowhere->setConstant(std::numeric_limits<double>::quiet_NaN());
  } else if (axes.size() < 3) {
    const auto& state = hand().at(psi, psid, psidd, t);
    for (int i = 0; i < 3; ++i) {
      if (std::find(axes.begin(), axes.end(), i) != axes.end()) continue;
      E.position[i] = state.position[i];
      E.velocity[i] = state.velocity[i];
      E.acceleration[i] = state.acceleration[i];
    }
  }
  Eigen::Map<Vector> out(row.data(), static_cast<Eigen::Index>(row.size()));
  out << psi, psid, psidd, E.position, E.velocity, E.acceleration;
}

// The path's rows, of each step of a lap and one for its end, checked.
void PlanMaker::follow(Plan& plan, std::int64_t delay) {
  const std::int64_t steps = lap_steps_;
  plan.table_.resize(static_cast<std::size_t>(steps * width_ + 1) * reference_size(plan.n_u_));
  samples_.resize(static_cast<std::size_t>(steps + 1) * measures_.count());
  Follower follower = this->follower(delay);
  const double t_start = follower.time(0);
  const auto on_branch = [&](const Vector& psi) { return measures_.on_home_branch(psi, t_start); };
  if (const IkOutcome outcome = follower.start(on_branch); outcome != IkOutcome::solved)
    refusal_.no_start(outcome, follower.now().motors.psi, t_start);
  measures_.adopt_scale(follower.now().motors.psi, t_start);
  AngleWatch angles(*model_.scene, model_.parameters);
  for (std::int64_t step = 0; step <= steps; ++step) {
    work_goes_on(kWork, step, steps);
    const auto at = static_cast<double>(step);
    if (follower.advance(at) != IkOutcome::solved) refusal_.no_way(follower, at);
    const double t = follower.time(at);
    if (const std::string jumped = jump(angles, follower.now().motors.psi, t); !jumped.empty())
      refusal_.jump(at, jumped);
    write(follower.now(), t, row(plan, step * width_));
    measures_.evaluate(follower.now().motors.psi, t,
                       samples_.data() + static_cast<std::size_t>(step) * measures_.count());
    if (step < steps) follow_within(plan, step, follower);
  }
  check_singularities(plan, delay);
  check_limits(plan, delay);
}

// Which angle jumped since the last look, and why.
std::string PlanMaker::jump(AngleWatch& angles, const Vector& motors, double t) const {
  if (!angles.needed()) return {};
  return angles.look(span_of(with_free_at_home(*model_.scene, {motors, {}, {}}).psi), t);
}

// The other rows of a step.
void PlanMaker::follow_within(Plan& plan, std::int64_t step, Follower& follower) {
  for (std::int64_t j = 1; j < width_; ++j) {
    const double at = static_cast<double>(step) + settings_.within[static_cast<std::size_t>(j)];
    if (follower.advance(at) != IkOutcome::solved) refusal_.no_way(follower, at);
    write(follower.now(), follower.time(at), row(plan, step * width_ + j));
  }
}

void PlanMaker::check_singularities(Plan& plan, std::int64_t delay) {
  Follower follower = this->follower(delay);
  const auto measures_at = [&](double step, double* values) {
    work_goes_on();
    const std::int64_t before = std::llround(std::floor(step));
    const Reference known = reference_in(row(plan, before * width_), plan.n_u_);
    follower.resume({static_cast<double>(before), {}, {known.psi, known.psid, known.psidd}});
    if (follower.advance(step) == IkOutcome::solved)
      return measures_.evaluate(follower.now().motors.psi, follower.time(step), values);
    std::fill_n(values, measures_.count(), 0.0);  // no solution between two solutions: a singularity
  };
  const auto passage = first_passage(samples_, measures_.count(), measures_at);
  if (!passage) return;
  std::vector<double> there(measures_.count());
  measures_at(passage->step, there.data());
  const double at = follower.now().step;
  refusal_.passage(*passage, measures_.lost(passage->measure, follower.now().motors.psi, follower.time(at)));
}

void PlanMaker::check_limits(Plan& plan, std::int64_t delay) {
  LimitCheck check(model_, settings_.limits);
  // Loads that depend on time make every lap's torques different.
  const std::int64_t laps = timed_loads_ ? itinerary_.steps() / lap_steps_ : 1;
  const Follower clock = follower(delay);
  for (std::int64_t lap = 0; lap < laps; ++lap)
    for (std::int64_t i = 0; i <= lap_steps_; ++i) {
      work_goes_on();
      const std::int64_t step = lap * lap_steps_ + i;
      check.look(step, reference_in(row(plan, i * width_), plan.n_u_), clock.time(static_cast<double>(step)));
    }
  if (check.worst()) refusal_.excess(*check.worst());
}

std::int64_t PlanMaker::approach_ticks(Plan& plan, const Vector& move) {
  const Reference start = reference_in(row(plan, 0), plan.n_u_);
  if ((move.cwiseAbs() - 1e-12 * hand_.motor_scale().cwiseMax(start.psi.cwiseAbs())).maxCoeff() <= 0)
    return 0;
  if (path_.approach) return ticks_of(*path_.approach, settings_.rate_hz, path_.place, "the approach");
  const Vector fastest = settings_.limits.velocity.empty()
                             ? fastest_on_path(plan)
                             : Vector(Eigen::Map<const Vector>(settings_.limits.velocity.data(), plan.n_u_));
  const double ticks = std::ceil(shortest_move(move, fastest) * settings_.rate_hz * (1 - 1e-10));
  require_room(ticks * settings_.stages_per_tick);
  return static_cast<std::int64_t>(ticks);
}

// Of each motor, what any motor of its kind reaches.
Vector PlanMaker::fastest_on_path(Plan& plan) const {
  Vector each = Vector::Zero(plan.n_u_), fastest = each;
  for (std::int64_t step = 0; step < lap_steps_; ++step)
    each = each.cwiseMax(reference_in(row(plan, step * width_), plan.n_u_).psid.cwiseAbs());
  const auto linear = [&](int i) { return model_.scene->motors()[static_cast<std::size_t>(i)].linear; };
  for (int i = 0; i < plan.n_u_; ++i)
    for (int j = 0; j < plan.n_u_; ++j)
      if (linear(i) == linear(j)) fastest[i] = std::max(fastest[i], each[j]);
  return fastest;
}

// Rows before the path's, checked. In the motors' space the end effector's Jacobian may be singular; what the
// scene names may not.
void PlanMaker::approach(Plan& plan, const Vector& from, std::int64_t ticks) {
  const std::int64_t steps = ticks * settings_.stages_per_tick;
  require_room(static_cast<double>(lap_steps_ + steps));
  const double rate = itinerary_.step_rate();
  const Reference start = reference_in(row(plan, 0), plan.n_u_);
  const MoveToStart move(from, {start.psi, start.psid, start.psidd}, static_cast<double>(steps) / rate);
  const auto at = [&](double step) { return move.at(step / static_cast<double>(steps)); };
  plan.table_.insert(plan.table_.begin(),
                     static_cast<std::size_t>(steps * width_) * reference_size(plan.n_u_), 0.0);
  plan.start_tick_ = ticks;
  plan.ticks_ += ticks;

  const std::size_t named = measures_.named();
  std::vector<double> values(measures_.count()), samples;
  LimitCheck check(model_, settings_.limits);
  AngleWatch angles(*model_.scene, model_.parameters);
  const auto fill = [&](double step, std::int64_t index) {
    const double t = step / rate;
    Follower::Motion motion{0, {}, at(step)};
    const auto& E = hand().at(motion.motors.psi, motion.motors.psid, motion.motors.psidd, t);
    if (!E.acceleration.allFinite()) refusal_.not_closed_before(step, move.duration());
    motion.desired = {E.position, E.velocity, E.acceleration};
    write(motion, t, row(plan, index));
  };
  for (std::int64_t step = 0; step < steps; ++step) {
    work_goes_on(kWork, step + 1, steps);
    for (std::int64_t j = 0; j < width_; ++j)
      fill(static_cast<double>(step) + settings_.within[static_cast<std::size_t>(j)], step * width_ + j);
    const Reference now = reference_in(row(plan, step * width_), plan.n_u_);
    const double t = static_cast<double>(step) / rate;
    check.look(step, now, t);
    if (const std::string jumped = jump(angles, now.psi, t); !jumped.empty())
      refusal_.jump_before(static_cast<double>(step), jumped, move.duration());
    measures_.evaluate(now.psi, t, values.data());
    samples.insert(samples.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(named));
  }
  const auto measures_at = [&](double step, double* out) {
    measures_.evaluate(at(step).psi, step / rate, values.data());
    std::copy_n(values.begin(), named, out);
  };
  if (const auto passage = first_passage(samples, named, measures_at))
    refusal_.passage_before(*passage, move.duration());
  if (check.worst()) refusal_.excess_before(*check.worst(), move.duration());
}

// The last row once more, without rates.
void PlanMaker::rest_past_the_end(Plan& plan) {
  const std::size_t size = reference_size(plan.n_u_);
  plan.table_.resize(plan.table_.size() + size);
  const auto n_u = static_cast<std::size_t>(plan.n_u_);
  const auto rest = std::span(plan.table_).last(size),
             end = std::span(plan.table_).last(2 * size).first(size);
  std::ranges::copy(end.first(n_u), rest.begin());
  std::ranges::copy(end.subspan(3 * n_u, 3), rest.subspan(3 * n_u).begin());
}

}  // namespace mixloop
