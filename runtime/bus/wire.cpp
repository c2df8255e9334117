// SPDX-License-Identifier: MIT
#include "runtime/bus/wire.hpp"

#include <bit>
#include <cmath>
#include <cstring>

namespace mixloop {
namespace {

// The kinds of rejection beside their counters, once.
template <class Counters>
auto& counter(Counters& rejects, Reject cause) {
  switch (cause) {
    case Reject::length:
      return rejects.length;
    case Reject::fingerprint:
      return rejects.fingerprint;
    case Reject::dimension:
      return rejects.dimension;
    case Reject::not_finite:
      return rejects.not_finite;
    case Reject::session:
      return rejects.session;
    case Reject::config:
      return rejects.config;
    case Reject::tick:
      return rejects.tick;
    case Reject::stale:
      break;
  }
  return rejects.stale;
}

static_assert(std::endian::native == std::endian::little);

std::int64_t big_endian_64(const std::uint8_t* at) {
  std::uint64_t bits;
  std::memcpy(&bits, at, sizeof bits);
  return static_cast<std::int64_t>(__builtin_bswap64(bits));
}

std::int32_t big_endian_32(const std::uint8_t* at) {
  std::uint32_t bits;
  std::memcpy(&bits, at, sizeof bits);
  return static_cast<std::int32_t>(__builtin_bswap32(bits));
}

constexpr std::size_t kFingerprint = 8, kHeader = kFingerprint + 4 + 4 * 8;

// x - x is zero for a finite x, NaN otherwise.
template <class... Values>
bool all_finite(const Values&... values) {
  double sum = 0;
  const auto add = [&sum](const auto& xs) {
    for (const double x : xs) sum += x - x;
  };
  (add(values), ...);
  return sum == 0;
}

void resize(std::size_t n, auto&... arrays) { (arrays.assign(n, 0.0), ...); }

}  // namespace

std::string_view name(Reject cause) {
  switch (cause) {
    case Reject::length:
      return "length";
    case Reject::fingerprint:
      return "fingerprint";
    case Reject::dimension:
      return "dimension";
    case Reject::not_finite:
      return "not_finite";
    case Reject::session:
      return "session";
    case Reject::config:
      return "config";
    case Reject::tick:
      return "tick";
    case Reject::stale:
      break;
  }
  return "stale";
}

void Rejects::count(Reject cause) { ++counter(*this, cause); }

std::uint64_t Rejects::of(Reject cause) const { return counter(*this, cause); }

std::uint64_t Rejects::total() const {
  return length + fingerprint + dimension + not_finite + session + config + tick + stale;
}

std::optional<Header> peek(Bytes bytes) {
  if (bytes.size() < kHeader) return std::nullopt;
  const std::uint8_t* at = bytes.data() + kFingerprint;
  return Header{.n = big_endian_32(at),
                .utime = big_endian_64(at + 4),
                .seq = big_endian_64(at + 12),
                .session = big_endian_64(at + 20),
                .config = big_endian_64(at + 28)};
}

template <>
state_t blank(int n) {
  state_t m{};
  m.n = n;
  resize(static_cast<std::size_t>(n), m.psi_measured, m.psid_measured);
  return m;
}
template <>
reference_t blank(int n) {
  reference_t m{};
  m.n = n;
  resize(static_cast<std::size_t>(n), m.psi_desired, m.psid_desired, m.psidd_desired);
  return m;
}
template <>
command_t blank(int n) {
  command_t m{};
  m.n = n;
  resize(static_cast<std::size_t>(n), m.tau_commanded);
  return m;
}
template <>
truth_t blank(int n) {
  truth_t m{};
  m.n = n;
  resize(static_cast<std::size_t>(n), m.psi, m.psid, m.psidd, m.tau_applied);
  return m;
}
template <>
sim_control_t blank(int n) {
  sim_control_t m{};
  m.n = n;
  return m;
}
template <>
stop_t blank(int n) {
  stop_t m{};
  m.n = n;
  return m;
}
template <>
fault_t blank(int n) {
  fault_t m{};
  m.n = n;
  return m;
}
template <>
timing_t blank(int n) {
  timing_t m{};
  m.n = n;
  return m;
}

bool is_finite(const state_t& m) { return all_finite(m.psi_measured, m.psid_measured); }
bool is_finite(const reference_t& m) {
  return all_finite(m.psi_desired, m.psid_desired, m.psidd_desired, m.position_desired, m.velocity_desired,
                    m.acceleration_desired);
}
bool is_finite(const command_t& m) { return all_finite(m.tau_commanded); }
bool is_finite(const truth_t& m) {
  const double scalars[] = {m.kinetic_energy, m.potential_energy, m.work};
  return all_finite(m.psi, m.psid, m.psidd, m.tau_applied, m.position, m.velocity, m.acceleration, scalars);
}
bool is_finite(const sim_control_t& m) { return std::isfinite(m.speed); }
bool is_finite(const stop_t&) { return true; }
bool is_finite(const fault_t& m) { return std::isfinite(m.magnitude) && std::isfinite(m.duration); }
bool is_finite(const timing_t& m) {
  return std::isfinite(m.success_last_100) && std::isfinite(m.relative_error);
}

template <class Message>
std::optional<Reject> Inbox<Message>::read(Bytes bytes) {
  // What n claims is checked before the length that follows from it, so that a wrong n is called that.
  const std::optional<Header> header = peek(bytes);
  if (!header) return Reject::length;
  if (big_endian_64(bytes.data()) != Message::getHash()) return Reject::fingerprint;
  if (header->n != n_) return Reject::dimension;
  if (bytes.size() != length_) return Reject::length;
  if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) != static_cast<int>(bytes.size()))
    return Reject::length;
  if (!is_finite(message)) return Reject::not_finite;
  return std::nullopt;
}

template class Inbox<state_t>;
template class Inbox<reference_t>;
template class Inbox<command_t>;
template class Inbox<truth_t>;
template class Inbox<sim_control_t>;
template class Inbox<stop_t>;
template class Inbox<fault_t>;
template class Inbox<timing_t>;

}  // namespace mixloop
