// SPDX-License-Identifier: MIT
#include "sweep/leading.hpp"

#include <fmt/format.h>

#include "sweep/journal.hpp"
#include "sweep/peer_words.hpp"

namespace mixloop {

Leading::Leading(Peers& peers, const Sweep& sweep, Work& work, std::chrono::milliseconds patience,
                 std::function<void(const std::string&)> said)
    : peers_(peers),
      sweep_(sweep),
      work_(work),
      patience_(patience),
      said_(std::move(said)),
      others_(static_cast<std::size_t>(peers.size())) {
  for (std::size_t rank = 0; rank < others_.size(); ++rank)
    others_[rank] = {.name = fmt::format("rank {}", rank), .heard = Clock::now()};
}

void Leading::look() {
  while (const auto message = peers_.receive()) take(*message);
  const auto now = Clock::now();
  if (now - told_ > kBeat) {
    tell(message_of(PeerWord::alive));
    told_ = now;
  }
  for (std::size_t rank = 1; rank < others_.size(); ++rank) {
    const Peer& peer = others_[rank];
    if (peer.state != Peer::State::lost && peer.state != Peer::State::done && now - peer.heard > patience_)
      lose(static_cast<int>(rank),
           fmt::format("has been silent for {:.3g} s", std::chrono::duration<double>(patience_).count()));
  }
}

void Leading::take(const Peers::Message& message) {
  Peer& peer = others_[static_cast<std::size_t>(message.from)];
  if (message.text.empty() || peer.state == Peer::State::lost) return;
  peer.heard = Clock::now();
  std::string_view rest = std::string_view(message.text).substr(1);
  switch (static_cast<PeerWord>(message.text.front())) {
    case PeerWord::hello: {
      const std::string_view hash = rest.substr(0, sweep_.sha256().size());
      peer.name += fmt::format(" ({})", rest.substr(hash.size()));
      if (hash != sweep_.sha256())
        return lose(message.from,
                    "reads other files, or is of another version: expected the same everywhere");
      peer.state = Peer::State::at_work;
      return;
    }
    case PeerWord::ready:
      return hand_out(message.from);
    case PeerWord::brought: {
      const Runs runs = runs_in(rest);
      work_.bring(message.from, outcomes_in(rest, runs.first, sweep_.telling().columns.size()));
      return hand_out(message.from);
    }
    case PeerWord::failed:
      return lose(message.from, "can't go on: " + std::string(rest));
    case PeerWord::done:
      peer.state = Peer::State::done;
      return;
    default:
      return;
  }
}

void Leading::hand_out(int rank) {
  if (stopped_) return;
  const Runs runs = work_.take(rank);
  if (runs.count > 0)
    peers_.send(rank, message_of(PeerWord::work, bytes_of(runs)));
  else
    ++others_[static_cast<std::size_t>(rank)].idle;
}

void Leading::lose(int rank, const std::string& why) {
  Peer& peer = others_[static_cast<std::size_t>(rank)];
  peer.state = Peer::State::lost;
  const std::int64_t runs = work_.lose(rank);
  said_(fmt::format("{} {}; the {} runs that it had are done by others", peer.name, why, runs));
  for (std::size_t i = 1; i < others_.size(); ++i)
    if (others_[i].state == Peer::State::at_work)
      for (int idle = std::exchange(others_[i].idle, 0); idle > 0; --idle) hand_out(static_cast<int>(i));
}

void Leading::stop() {
  if (!std::exchange(stopped_, true)) tell(message_of(PeerWord::stop));
}

bool Leading::is_over() const {
  if (!stopped_) return work_.is_done();
  for (std::size_t rank = 1; rank < others_.size(); ++rank)
    if (others_[rank].state == Peer::State::at_work) return false;
  return true;
}

void Leading::end() {
  bool together = true;
  for (std::size_t rank = 1; rank < others_.size(); ++rank)
    together =
        together && others_[rank].state != Peer::State::lost && others_[rank].state != Peer::State::starting;
  tell(message_of(PeerWord::end, together ? "1" : "0"));  // those given up for lost may yet hear it
  peers_.leave(together);
}

void Leading::tell(const std::string& message) {
  for (int rank = 1; rank < peers_.size(); ++rank) peers_.send(rank, message);
}

}  // namespace mixloop
