// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace mixloop {

/// The processes that were started together for one sweep, and messages between them; those of one to another
/// arrive in their order. One thread uses it.
class Peers {
 public:
  struct Message {
    int from = 0;
    std::string text;
  };

  virtual ~Peers() = default;
  virtual int rank() const = 0;  ///< rank 0 leads
  virtual int size() const = 0;
  /// Returns at once; whether it arrives is the other's matter.
  virtual void send(int to, std::string text) = 0;
  /// One that has arrived; nothing where there is none.
  virtual std::optional<Message> receive() = 0;
  /// Nothing is sent or received any more. `together`: all of them do so; else some are lost, and none is
  /// waited for.
  virtual void leave(bool together) = 0;
};

/// What a module that knows MPI has: its one instance. Called once, before other threads start.
inline constexpr const char* kPeersSymbol = "mixloop_mpi_peers";
using MakePeers = Peers* (*)();

}  // namespace mixloop
