// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "runtime/clock/stop_switch.hpp"
#include "view/source.hpp"

namespace mixloop {

struct ServerOptions {
  std::uint16_t port = 7680;      ///< on 127.0.0.1; 0: one that is free
  double frames_per_second = 60;  ///< sent to a browser at most
  std::size_t most_clients = 16;
};

struct ServerState;  // of server.cpp

/// Serves the page, /scene.json and, over a WebSocket (/live), poses; on 127.0.0.1 only, to requests whose
/// Host is that, and WebSockets to pages whose Origin is that. A browser that reads slowly is sent fewer
/// poses. What a page sends is at most the tick of a log that it wants to see: nothing goes on to the bus.
class Server {
 public:
  /// Binds. Throws RunFault("cannot_listen").
  Server(const ServerOptions& options, std::string page);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;

  /// Until the switch is turned.
  void run(Source& source, const StopSwitch& stop);

 private:
  std::unique_ptr<ServerState> shared_;
};

}  // namespace mixloop
