// SPDX-License-Identifier: MIT
#include "watch/session_judge.hpp"

#include <algorithm>

#include "runtime/protocol/config_hash.hpp"
#include "runtime/protocol/ending.hpp"

namespace mixloop {

SessionJudge::SessionJudge(const Experiment& experiment, const Plan& plan)
    : experiment_(experiment),
      plan_(plan),
      recorder_(experiment, plan, {.knows_work = false}),
      config_(config_of(common_ground(experiment))),
      states_(experiment.scene->n()),
      commands_(experiment.scene->n_u()),
      controls_(experiment.scene->n()),
      ticks_({.config = config_,
              .complete = [](const HeardTick& tick) { return tick.get<state_t>() && tick.get<command_t>(); },
              .on_tick = [this](const HeardTick& tick) { judge(tick); }}) {}

void SessionJudge::on_state(Bytes bytes) {
  if (over() || states_.read(bytes)) return;
  const state_t& state = states_.message;
  if (state.config != config_) return;  // another experiment's plant
  if (session_ == 0) {
    session_ = state.session;
    ticks_.begin(session_, state.seq);
    if (early_) ticks_.add(*early_);
  }
  if (state.seq <= plan_.ticks())
    ticks_.add(state);
  else if (state.session == session_ && (state.flags & state_t::FLAG_HOLD) != 0)
    end_at(plan_.ticks());
}

void SessionJudge::on_command(Bytes bytes) {
  if (over() || commands_.read(bytes)) return;
  if (session_ == 0)
    early_ = commands_.message;
  else
    ticks_.add(commands_.message);
}

void SessionJudge::on_control(Bytes bytes) {
  if (over() || controls_.read(bytes)) return;
  const sim_control_t& control = controls_.message;
  if (session_ == 0 || control.session != session_ || control.action != sim_control_t::ACTION_END) return;
  end_at(control.seq);
  broken_off_ = ending_of(control.reason) != Ending::finished;
}

void SessionJudge::judge(const HeardTick& tick) {
  if (diverged_) return;
  judged_ = tick.k;
  const auto* state = tick.get<state_t>();
  const auto* command = tick.get<command_t>();
  if (!state) return;
  if ((state->flags & state_t::FLAG_SAFE_STATE) != 0 && !safe_) {
    safe_ = true;
    recorder_.made_safe(tick.k);
  }
  diverged_ = !recorder_.state(tick.k, state->psi_measured, state->psid_measured, 0.0);
  if (!command || diverged_) return;
  ++complete_;
  diverged_ = !recorder_.command(tick.k, command->tau_commanded, command->tau_commanded);
  if (tick.k == plan_.ticks()) end_at(tick.k);
}

Result SessionJudge::finish(bool interrupted, double wall_time) {
  ticks_.finish();
  if (interrupted || broken_off_) recorder_.interrupted();
  Measures measures = recorder_.measures();
  const std::int64_t missing = plan_.ticks() + 1 - complete_;
  if (missing > 0) measures.trajectory_sha256.clear();
  Result result = result_of(experiment_, measures, "attached", equations().evaluation(), wall_time);
  result.missing_ticks = missing;
  result.session = session_;
  return result;
}

}  // namespace mixloop
