// SPDX-License-Identifier: MIT
#include "report/log_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "mixloop_lcm/fields.hpp"
#include "notation/errors.hpp"
#include "notation/long_work.hpp"
#include "runtime/bus/log_reader.hpp"
#include "watch/tick_assembly.hpp"

namespace mixloop {
namespace {

constexpr const char* kReading = "reading a log";
constexpr std::int32_t kMostMotors = 1000;
constexpr std::int64_t kFarthestJump = 100'000;  // ticks: past it a tick can't be

bool sound(const Header& header) {
  return header.n >= 0 && header.n <= kMostMotors && header.session != 0 && header.seq >= 0;
}

/// The rate that gives `utime` = floor(seq / rate): a round one where it fits.
double rate_of(std::int64_t seq, std::int64_t utime) {
  if (seq <= 0 || utime <= 0) return 1000;
  const double rate = static_cast<double>(seq) * 1e6 / (static_cast<double>(utime) + 0.5);
  const double round = std::round(rate);
  const bool fits = std::abs(static_cast<double>(seq) * 1e6 / round - static_cast<double>(utime)) <= 1;
  return fits ? round : rate;
}

void copy_motion(const double* position, const double* velocity, const double* acceleration, Motion& to) {
  to.position = Eigen::Map<const Eigen::Vector3d>(position);
  to.velocity = Eigen::Map<const Eigen::Vector3d>(velocity);
  to.acceleration = Eigen::Map<const Eigen::Vector3d>(acceleration);
}

/// Tells a session's ticks as its messages are added.
class SessionReader {
 public:
  SessionReader(const LogSession& session, double rate_hz, const RunSizes& sizes,
                const std::function<void(Tick&)>& on_tick)
      : session_(session),
        rate_hz_(rate_hz),
        blank_(sizes),
        on_tick_(on_tick),
        inboxes_(session.n, static_cast<int>(sizes.n_u), static_cast<int>(sizes.n_u),
                 session.n_all > 0 ? session.n_all : session.n),
        ticks_(
            {.farthest_jump = kFarthestJump, .on_tick = [this](const HeardTick& tick) { tell_up_to(tick); }}),
        next_(session.first_tick),
        last_tau_(blank_.tau),
        last_psi_(blank_.psi) {
    ticks_.begin(session.session, session.first_tick);
  }

  void add(std::string_view kind, const LogEvent& event) {
    if (kind == "FAULT") take_fault(event);
    if (kind == "STOP" || kind == "SIM_CONTROL" || kind == "FAULT") return;
    const auto header = peek(event.data);
    if (!header || !sound(*header)) {
      ++facts.dropped;
    } else if (header->session == session_.session) {
      if (kind == "STATE") take<state_t>(event);
      if (kind == "REFERENCE") take<reference_t>(event);
      if (kind == "COMMAND") take<command_t>(event);
      if (kind == "TRUTH") take<truth_t>(event);
      if (kind == "TIMING") take_timing(event);
    }
  }

  void finish() { ticks_.finish(); }

  LogFacts facts;

 private:
  template <class Message>
  void take(const LogEvent& event) {
    auto& inbox = std::get<Inbox<Message>>(inboxes_);
    if (inbox.read(event.data) || ticks_.add(inbox.message, event.received_us) == Taken::early)
      ++facts.dropped;
  }

  void take_timing(const LogEvent& event) {
    timing_t timing;
    if (decode(event.data, timing))
      facts.timing.push_back(timing);
    else
      ++facts.dropped;
  }

  // Each is sent some times over, with the same number.
  void take_fault(const LogEvent& event) {
    fault_t m{};
    if (!decode(event.data, m) || m.session != session_.session || m.seq <= last_fault_) return;
    if (m.target < fault_t::TARGET_MOTOR || m.target > fault_t::TARGET_FRICTION) return;
    if (m.kind < fault_t::KIND_NONE || m.kind > fault_t::KIND_CHANGED) return;
    last_fault_ = m.seq;
    const double at = std::max(1e-6 * static_cast<double>(m.utime), static_cast<double>(next_) / rate_hz_);
    facts.faults.push_back({next_,
                            {.target = static_cast<Fault::Target>(m.target),
                             .kind = static_cast<Fault::Kind>(m.kind),
                             .index = m.index,
                             .magnitude = m.magnitude,
                             .at = at,
                             .duration = m.duration}});
  }

  void tell_up_to(const HeardTick& heard) {
    for (HeardTick unheard; next_ < heard.k; ++next_) {
      unheard.k = next_;
      tell(unheard);
    }
    tell(heard);
    ++next_;
  }

  void tell(const HeardTick& heard) {
    const auto* state = heard.get<state_t>();
    const auto* reference = heard.get<reference_t>();
    const auto* command = heard.get<command_t>();
    const auto* truth = heard.get<truth_t>();
    facts.states_missing += !state;
    facts.references_missing += state && !reference;
    facts.commands_missing += state && !command;
    facts.has_truth |= truth != nullptr;

    Tick tick = blank_;
    tick.k = heard.k;
    tick.t = static_cast<double>(heard.k) / rate_hz_;
    if (state) take_state(*state, tick);
    tick.judged = !(state && (state->flags & state_t::FLAG_SAFE_STATE) != 0) &&
                  !(reference && reference->phase == reference_t::PHASE_MOVE_TO_START);
    if (reference) {
      tick.psi_desired = reference->psi_desired;
      copy_motion(reference->position_desired, reference->velocity_desired, reference->acceleration_desired,
                  tick.desired);
    }
    if (command) tick.tau = tick.tau_applied = command->tau_commanded;
    if (const std::int64_t age = heard.heard_at<command_t>() - heard.heard_at<state_t>();
        state && command && age >= 0)  // else it is the state's first sending that the log lacks
      tick.command_age = static_cast<double>(age) * 1e-6;
    if (truth) take_truth(*truth, tick);
    add_work(tick);
    on_tick_(tick);
  }

  void take_state(const state_t& state, Tick& tick) {
    facts.is_real_time |= (state.flags & state_t::FLAG_REAL_TIME) != 0;
    facts.reached_safe_state |= (state.flags & state_t::FLAG_SAFE_STATE) != 0;
    for (std::size_t i = 0; i < state.psi_measured.size(); ++i) {
      const std::size_t of = session_.measured.empty() ? i : static_cast<std::size_t>(session_.measured[i]);
      if (of >= tick.psi.size()) continue;
      tick.psi[of] = state.psi_measured[i];
      tick.psid[of] = state.psid_measured[i];
    }
  }

  void take_truth(const truth_t& truth, Tick& tick) {
    if (tick.psi.size() > static_cast<std::size_t>(session_.n) && truth.psi.size() == tick.psi.size())
      take_unmeasured(truth, tick);
    std::copy_n(truth.tau_applied.begin(), tick.tau_applied.size(), tick.tau_applied.begin());
    copy_motion(truth.position, truth.velocity, truth.acceleration, tick.actual);
    tick.kinetic_energy = truth.kinetic_energy;
    tick.potential_energy = truth.potential_energy;
    tick.work = truth.work;
  }

  void take_unmeasured(const truth_t& truth, Tick& tick) {
    for (std::size_t i = 0; i < tick.psi.size(); ++i)
      if (std::isnan(tick.psi[i])) tick.psi[i] = truth.psi[i], tick.psid[i] = truth.psid[i];
  }

  // W(k) = W(k-1) + tau(k-1) . (psi(k) - psi(k-1)) for a torque that is held; over a gap the last one that is
  // known.
  void add_work(Tick& tick) {
    if (!std::isnan(tick.psi[0])) {
      double work = 0;
      for (std::size_t i = 0; i < last_tau_.size(); ++i) work += last_tau_[i] * (tick.psi[i] - last_psi_[i]);
      if (!std::isnan(work)) work_ += work;
      last_psi_ = tick.psi;
      if (std::isnan(tick.work)) tick.work = work_;
    }
    if (!tick.tau_applied.empty() && !std::isnan(tick.tau_applied[0])) last_tau_ = tick.tau_applied;
  }

  const LogSession& session_;
  double rate_hz_;
  const Tick blank_;
  const std::function<void(Tick&)>& on_tick_;
  std::tuple<Inbox<state_t>, Inbox<reference_t>, Inbox<command_t>, Inbox<truth_t>> inboxes_;
  TickAssembly ticks_;
  std::int64_t next_;  ///< the tick to tell
  std::vector<double> last_tau_, last_psi_;
  double work_ = 0;
  std::int64_t last_fault_ = -1;
};

std::string_view kind_of(const LogEvent& event, const std::string& prefix) {
  return event.channel.starts_with(prefix) ? event.channel.substr(prefix.size()) : std::string_view();
}

}  // namespace

std::vector<LogSession> sessions_in(const std::filesystem::path& log, const std::string& prefix) {
  LogReader reader(log);
  std::map<std::int64_t, LogSession> found;
  std::map<std::int64_t, std::int64_t> utime;   // of the session's last tick
  std::map<std::int64_t, std::int32_t> motors;  // as the session's first command counts them
  std::map<std::int64_t, std::int32_t> all;     // and its first truth
  while (const LogEvent* event = reader.next()) {
    work_goes_on(kReading, reader.position(), reader.size());
    const auto header = peek(event->data);
    if (!header || !sound(*header)) continue;
    const auto is = [&](const char* kind, std::int64_t type) {
      return kind_of(*event, prefix) == kind && fingerprint(event->data) == type;
    };
    if (is("COMMAND", command_t::getHash())) motors.try_emplace(header->session, header->n);
    if (is("TRUTH", truth_t::getHash())) all.try_emplace(header->session, header->n);
    if (!is("STATE", state_t::getHash())) continue;
    auto [at, is_new] = found.try_emplace(
        header->session,
        LogSession{
            .session = header->session, .n = header->n, .first_tick = header->seq, .last_tick = header->seq});
    LogSession& session = at->second;
    ++session.states;
    session.first_tick = std::min(session.first_tick, header->seq);
    if (!is_new && header->seq > session.last_tick + kFarthestJump) continue;
    if (!is_new && header->seq < session.last_tick) continue;
    session.last_tick = header->seq;
    utime[header->session] = header->utime;
  }
  std::vector<LogSession> sessions;
  for (auto& [id, session] : found) {
    session.rate_hz = rate_of(session.last_tick, utime[id]);
    session.n_u = motors[id];
    session.n_all = all[id];
    sessions.push_back(session);
  }
  std::stable_sort(sessions.begin(), sessions.end(),
                   [](const LogSession& a, const LogSession& b) { return a.states > b.states; });
  if (sessions.empty())
    throw InputError("no_states", {log.string()},
                     "no message of type mixloop_lcm.state_t on a channel " + prefix +
                         "STATE; expected the log of a run (another prefix? --channel-prefix)");
  return sessions;
}

LogFacts read_log(const std::filesystem::path& log, const std::string& prefix, const LogSession& session,
                  double rate_hz, const RunSizes& sizes, const std::function<void(Tick&)>& on_tick) {
  LogReader reader(log);
  SessionReader ticks(session, rate_hz, sizes, on_tick);
  while (const LogEvent* event = reader.next()) {
    work_goes_on(kReading, reader.position(), reader.size());
    if (const auto kind = kind_of(*event, prefix); !kind.empty()) ticks.add(kind, *event);
  }
  ticks.finish();
  ticks.facts.damage = reader.damage();
  return ticks.facts;
}

}  // namespace mixloop
