// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/receiver.hpp"
#include "runtime/clock/clock.hpp"

namespace mixloop {

/// What was heard of a second sender.
struct Rival {
  std::uint64_t messages = 0;  ///< that were not taken
  std::int64_t tick = 0;       ///< of the first of them
  Endpoint taken, refused;
  bool proved = false;  ///< both are there at once, no one in the other's place
};

/// As "a second sender on MIXLOOP_COMMAND: ..."; empty where none is proved.
std::string describe(const Rival& rival, const std::string& channel);

/// Of messages that one process of a session sends: whose are taken. The first that is heard, until it has
/// been silent for a second: a process that is started again has another port. What others send, or another
/// message of a tick that was taken, is left alone and counted. Allocates only at the first message.
class SoleSender {
 public:
  static constexpr nanoseconds kQuiet = std::chrono::seconds(1);

  /// Whether what comes from there, heard now, may be taken.
  bool admits(Endpoint sender, Instant at) const {
    return !sender_ || *sender_ == sender || (heard_ && silent(at));
  }
  /// Nothing was taken for long, or at all.
  bool silent(Instant at) const { return !heard_ || at - *heard_ > kQuiet; }
  /// Takes it.
  void take(const Received& message, Instant at);
  /// Leaves a message of this tick alone.
  void refuse(Endpoint sender, std::int64_t tick);
  /// Whether these are not the bytes that were taken last, though they should be: then it is left alone.
  bool contradicts(const Received& message, std::int64_t tick);
  /// The same sender, of which nothing is heard yet.
  void begin_again() { heard_.reset(); }

  bool heard() const { return heard_.has_value(); }
  std::optional<Endpoint> sender() const { return sender_; }
  const Rival& rival() const { return rival_; }
  /// Says to `notice`, once, that there is a rival. Cheap while there is nothing to say.
  void tell(const std::string& channel, const std::function<void(const std::string&)>& notice);

 private:
  std::optional<Endpoint> sender_;
  std::optional<Instant> heard_;
  std::vector<std::uint8_t> last_;
  Rival rival_;
  bool told_ = false;
};

}  // namespace mixloop
