// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <tuple>
#include <type_traits>
#include <vector>

#include "runtime/bus/wire.hpp"
#include "runtime/clock/plant_time.hpp"

namespace mixloop {

/// What was heard of one tick.
class HeardTick {
 public:
  std::int64_t k = -1;

  /// Its message of this type; null where none was heard.
  template <class Message>
  const Message* get() const {
    const auto& part = std::get<Part<Message>>(parts_);
    return part.heard ? &part.message : nullptr;
  }
  /// When that was heard, as TickAssembly::add was told.
  template <class Message>
  std::int64_t heard_at() const {
    return std::get<Part<Message>>(parts_).at;
  }

 private:
  friend class TickAssembly;

  template <class Message>
  struct Part {
    Message message{};
    std::int64_t at = 0;
    bool heard = false;
  };
  std::tuple<Part<state_t>, Part<reference_t>, Part<command_t>, Part<truth_t>> parts_;
};

/// What became of a message.
enum class Taken : std::uint8_t {
  fresh,          ///< the first of its type for its tick
  repeated,       ///< its tick has one already, which counts
  late,           ///< its tick is over
  early,          ///< farther ahead than its tick can be
  other_session,  ///< of another run
  other_config,   ///< of another experiment
};

/// Puts the messages of a session together, tick by tick, whatever was lost, doubled or overtaken on the way.
///
/// It keeps a window of ticks, which the newest STATE moves on. The ticks of which anything was heard are
/// given in their order: when they are complete, or without what is missing when a STATE comes that is
/// `patience` ticks newer. A tick that is given may still be looked up while the window has it.
class TickAssembly {
 public:
  static constexpr std::int64_t kBehind = 192;  ///< ticks kept up to the newest STATE's
  static constexpr std::int64_t kAhead = 64;    ///< ticks kept past it: references come early

  struct Options {
    std::int64_t behind = kBehind;
    std::int64_t patience = kBehind;                ///< `behind` where that is less
    std::int64_t farthest_jump = kFarthestTick;     ///< ticks: a STATE that is so much newer can't be
    std::optional<std::int64_t> config;             ///< that messages must have; any, where it isn't given
    bool (*complete)(const HeardTick&) = nullptr;   ///< whether nothing more is waited for
    std::function<void(const HeardTick&)> on_tick;  ///< is given the ticks
  };
  explicit TickAssembly(Options options);

  /// Forgets all, and takes the messages of this session from tick `first` on.
  void begin(std::int64_t session, std::int64_t first);
  std::int64_t session() const { return session_; }  ///< 0 before any
  std::int64_t newest() const { return newest_; }    ///< STATE's tick; that before the first, where none came

  /// Takes a message that was heard at some time, on any clock, and gives what ticks it makes due.
  template <class Message>
  Taken add(const Message& message, std::int64_t at = 0) {
    if (options_.config && message.config != *options_.config) return Taken::other_config;
    if (message.session != session_) return Taken::other_session;
    const Taken place = make_place(message.seq, std::is_same_v<Message, state_t>);
    if (place != Taken::fresh) return place;
    auto& part = std::get<HeardTick::Part<Message>>(slot(message.seq).parts_);
    if (part.heard) return Taken::repeated;
    part.message = message;
    part.at = at;
    part.heard = true;
    give_complete();
    return Taken::fresh;
  }

  /// Gives what is left, to the newest STATE's tick.
  void finish() { give_before(newest_ + 1); }

  /// What is known of a tick; null where that is nothing, or no more.
  const HeardTick* find(std::int64_t k) const;
  template <class Message>
  const Message* find(std::int64_t k) const {
    const HeardTick* tick = find(k);
    return tick ? tick->get<Message>() : nullptr;
  }

 private:
  std::int64_t size() const { return static_cast<std::int64_t>(slots_.size()); }
  HeardTick& slot(std::int64_t k) { return slots_[static_cast<std::size_t>(k % size())]; }
  Taken make_place(std::int64_t k, bool is_state);
  void give_before(std::int64_t end);
  void give_complete();

  Options options_;
  std::vector<HeardTick> slots_;  ///< tick k of the window at k modulo their number
  std::int64_t session_ = 0, newest_ = -1;
  std::int64_t from_ = 0, next_ = 0;  ///< the window's first tick; the next one to give
};

}  // namespace mixloop
