// SPDX-License-Identifier: MIT
// Peers by MPI: a module of its own, which only a process that mpirun started loads.
#include <mpi.h>

#include <list>
#include <vector>

#include "sweep/peers.hpp"

namespace {

class MpiPeers final : public mixloop::Peers {
 public:
  MpiPeers() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    // A rank that died is no reason to die.
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, std::string text) override {
    sent_.remove_if([](Sent& sent) { return sent.is_over(); });
    Sent& sent = sent_.emplace_back(Sent{std::move(text), MPI_REQUEST_NULL});
    MPI_Isend(sent.text.data(), static_cast<int>(sent.text.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD,
              &sent.request);
  }

  std::optional<Message> receive() override {
    sent_.remove_if([](Sent& sent) { return sent.is_over(); });
    int arrived = 0, size = 0;
    MPI_Status status;
    const int probed = MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &arrived, &status);
    if (probed != MPI_SUCCESS || arrived == 0) return std::nullopt;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Message message{status.MPI_SOURCE, std::string(static_cast<std::size_t>(size), '\0')};
    const int received =
        MPI_Recv(message.text.data(), size, MPI_BYTE, status.MPI_SOURCE, 0, MPI_COMM_WORLD, &status);
    if (received != MPI_SUCCESS) return std::nullopt;
    return message;
  }

  /// With one that is lost MPI_Finalize would wait for good.
  void leave(bool together) override {
    if (together) MPI_Finalize();
  }

 private:
  struct Sent {
    std::string text;
    MPI_Request request;

    bool is_over() {
      int over = 0;
      return MPI_Test(&request, &over, MPI_STATUS_IGNORE) != MPI_SUCCESS || over != 0;
    }
  };

  int rank_ = 0, size_ = 1;
  std::list<Sent> sent_;  ///< their texts stay where they are until they have gone
};

}  // namespace

extern "C" __attribute__((visibility("default"))) mixloop::Peers* mixloop_mpi_peers() {
  static auto* const peers = new MpiPeers;  // MPI is left, or not, by leave()
  return peers;
}
