// SPDX-License-Identifier: MIT
#include "report/log_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mixloop/timing_t.hpp"
#include "notation/errors.hpp"
#include "runtime/bus/log_reader.hpp"

namespace mixloop {
namespace {

constexpr std::int32_t kMostMotors = 1000;
constexpr std::int64_t kWindow = 256;            // ticks kept open
constexpr std::int64_t kAhead = 64;              // of them past the latest state: references come early
constexpr std::int64_t kFarthestJump = 100'000;  // ticks: past it a tick can't be

bool sound(const Header& header) {
  return header.n >= 1 && header.n <= kMostMotors && header.session != 0 && header.seq >= 0;
}

/// The rate that gives `utime` = floor(seq / rate): a round one where it fits.
double rate_of(std::int64_t seq, std::int64_t utime) {
  if (seq <= 0 || utime <= 0) return 1000;
  const double rate = static_cast<double>(seq) * 1e6 / (static_cast<double>(utime) + 0.5);
  const double round = std::round(rate);
  const bool fits = std::abs(static_cast<double>(seq) * 1e6 / round - static_cast<double>(utime)) <= 1;
  return fits ? round : rate;
}

/// A tick while its messages come in.
struct Slot {
  Tick tick;
  bool state = false, command = false, reference = false;
  std::int64_t sent_us = 0;
};

/// Puts the messages of a session together, tick by tick.
class Assembly {
 public:
  Assembly(const LogSession& session, double rate_hz, const RunSizes& sizes,
           const std::function<void(Tick&)>& on_tick)
      : session_(session),
        rate_hz_(rate_hz),
        blank_(sizes),
        on_tick_(on_tick),
        state_(session.n),
        reference_(static_cast<int>(sizes.n_u)),
        command_(static_cast<int>(sizes.n_u)),
        truth_(session.n),
        next_(session.first_tick),
        latest_(session.first_tick - 1) {
    slots_.assign(kWindow, Slot{.tick = blank_});
    last_tau_ = blank_.tau;
    last_psi_ = blank_.psi;
  }

  void add(std::string_view kind, const LogEvent& event) {
    if (kind == "STOP" || kind == "SIM_CONTROL" || kind == "FAULT") return;
    const auto header = peek(event.data);
    if (!header || !sound(*header)) {
      ++facts.dropped;
    } else if (header->session == session_.session) {
      if (kind == "STATE") take(state_, event, &Assembly::on_state);
      if (kind == "REFERENCE") take(reference_, event, &Assembly::on_reference);
      if (kind == "COMMAND") take(command_, event, &Assembly::on_command);
      if (kind == "TRUTH") take(truth_, event, &Assembly::on_truth);
      if (kind == "TIMING") on_timing(event);
    }
  }

  void finish() {
    while (next_ <= latest_) emit();
  }

  LogFacts facts;

 private:
  template <class Message>
  void take(Inbox<Message>& inbox, const LogEvent& event,
            void (Assembly::*on)(const Message&, Slot&, std::int64_t)) {
    const bool read = !inbox.read(event.data);
    Slot* slot = read ? slot_of(inbox.message.seq, std::is_same_v<Message, state_t>) : nullptr;
    if (slot)
      (this->*on)(inbox.message, *slot, event.received_us);
    else if (!read || inbox.message.seq > latest_)
      ++facts.dropped;
  }

  /// Null for a tick that is told already or can't be.
  Slot* slot_of(std::int64_t k, bool is_state) {
    if (k < next_ || k > latest_ + kFarthestJump || (!is_state && k >= next_ + kWindow)) return nullptr;
    if (is_state) {
      while (k + kAhead >= next_ + kWindow) emit();
      latest_ = std::max(latest_, k);
    }
    return &slots_[static_cast<std::size_t>(k % kWindow)];
  }

  static void copy(const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); }
  static void copy_motion(const double* position, const double* velocity, const double* acceleration,
                          Motion& to) {
    to.position = Eigen::Map<const Eigen::Vector3d>(position);
    to.velocity = Eigen::Map<const Eigen::Vector3d>(velocity);
    to.acceleration = Eigen::Map<const Eigen::Vector3d>(acceleration);
  }

  void on_state(const state_t& message, Slot& slot, std::int64_t received_us) {
    facts.is_real_time |= (message.flags & state_t::FLAG_REAL_TIME) != 0;
    facts.reached_safe_state |= (message.flags & state_t::FLAG_SAFE_STATE) != 0;
    if (std::exchange(slot.state, true)) return;  // sent again
    slot.sent_us = received_us;
    copy(message.psi_measured, slot.tick.psi);
    copy(message.psid_measured, slot.tick.psid);
  }

  void on_reference(const reference_t& message, Slot& slot, std::int64_t) {
    slot.reference = true;
    copy(message.psi_desired, slot.tick.psi_desired);
    copy_motion(message.position_desired, message.velocity_desired, message.acceleration_desired,
                slot.tick.desired);
  }

  void on_command(const command_t& message, Slot& slot, std::int64_t received_us) {
    if (std::exchange(slot.command, true)) return;
    copy(message.tau_commanded, slot.tick.tau);
    if (slot.state) slot.tick.command_age = static_cast<double>(received_us - slot.sent_us) * 1e-6;
    if (std::isnan(slot.tick.tau_applied[0])) slot.tick.tau_applied = slot.tick.tau;
  }

  void on_truth(const truth_t& message, Slot& slot, std::int64_t) {
    facts.has_truth = true;
    Tick& tick = slot.tick;
    std::copy_n(message.tau_applied.begin(), tick.tau_applied.size(), tick.tau_applied.begin());
    copy_motion(message.position, message.velocity, message.acceleration, tick.actual);
    tick.kinetic_energy = message.kinetic_energy;
    tick.potential_energy = message.potential_energy;
    tick.work = message.work;
  }

  void on_timing(const LogEvent& event) {
    timing_t m;
    const int size = static_cast<int>(event.data.size());
    if (m.decode(event.data.data(), 0, size) != size) {
      ++facts.dropped;
      return;
    }
    const auto s = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
    facts.timing.push_back({static_cast<double>(m.seq) / rate_hz_, s(m.round_trip_p50), s(m.round_trip_p99),
                            s(m.round_trip_max), s(m.wake_up_p50), s(m.wake_up_p99), s(m.wake_up_max),
                            static_cast<double>(m.missed), static_cast<double>(m.resent),
                            static_cast<double>(m.overruns)});
  }

  void emit() {
    Slot& slot = slots_[static_cast<std::size_t>(next_ % kWindow)];
    Tick& tick = slot.tick;
    facts.states_missing += !slot.state;
    facts.commands_missing += slot.state && !slot.command;
    facts.references_missing += slot.state && !slot.reference;
    tick.k = next_;
    tick.t = static_cast<double>(next_) / rate_hz_;
    add_work(tick);
    on_tick_(tick);
    slot = Slot{.tick = blank_};
    ++next_;
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
    if (!std::isnan(tick.tau_applied[0])) last_tau_ = tick.tau_applied;
  }

  const LogSession& session_;
  double rate_hz_;
  const Tick blank_;
  const std::function<void(Tick&)>& on_tick_;
  Inbox<state_t> state_;
  Inbox<reference_t> reference_;
  Inbox<command_t> command_;
  Inbox<truth_t> truth_;
  std::vector<Slot> slots_;
  std::int64_t next_, latest_;  ///< the tick to emit, and the latest that has a STATE
  std::vector<double> last_tau_, last_psi_;
  double work_ = 0;
};

std::string_view kind_of(const LogEvent& event, const std::string& prefix) {
  return event.channel.starts_with(prefix) ? event.channel.substr(prefix.size()) : std::string_view();
}

}  // namespace

std::vector<LogSession> sessions_in(const std::filesystem::path& log, const std::string& prefix) {
  LogReader reader(log);
  std::map<std::int64_t, LogSession> found;
  std::map<std::int64_t, std::int32_t> motors;
  std::map<std::int64_t, std::int64_t> utime;  // of the session's last tick
  while (const LogEvent* event = reader.next()) {
    const auto header = peek(event->data);
    if (!header || !sound(*header)) continue;
    std::uint64_t type = 0;
    for (std::size_t i = 0; i < 8; ++i) type = type << 8 | event->data[i];
    const auto is = [&](const char* kind, std::int64_t fingerprint) {
      return kind_of(*event, prefix) == kind && type == static_cast<std::uint64_t>(fingerprint);
    };
    if (is("COMMAND", command_t::getHash())) motors.try_emplace(header->session, header->n);
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
    sessions.push_back(session);
  }
  std::stable_sort(sessions.begin(), sessions.end(),
                   [](const LogSession& a, const LogSession& b) { return a.states > b.states; });
  if (sessions.empty())
    throw InputError("no_states", {log.string()},
                     "no message of type mixloop.state_t on a channel " + prefix +
                         "STATE; expected the log of a run (another prefix? --channel-prefix)");
  return sessions;
}

LogFacts read_log(const std::filesystem::path& log, const std::string& prefix, const LogSession& session,
                  double rate_hz, const RunSizes& sizes, const std::function<void(Tick&)>& on_tick) {
  LogReader reader(log);
  Assembly assembly(session, rate_hz, sizes, on_tick);
  while (const LogEvent* event = reader.next())
    if (const auto kind = kind_of(*event, prefix); !kind.empty()) assembly.add(kind, *event);
  assembly.finish();
  assembly.facts.damage = reader.damage();
  return assembly.facts;
}

}  // namespace mixloop
