// SPDX-License-Identifier: MIT
// The floor under lockstep: three processes exchange its messages over plain LCM, with nothing computed,
// checked, encoded or decoded. Plant: STATE, then wait for COMMAND. Planner: REFERENCE for every STATE.
// Controller: COMMAND for every STATE.
//   lockstep_bare [TICKS [N]]
#include <lcm/lcm.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "runtime/clock.hpp"
#include "runtime/histogram.hpp"
#include "runtime/wire.hpp"

namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr int kWarmUp = 200;

template <class Message>
std::vector<std::uint8_t> bytes_of_blank(int n) {
  mixloop::Outbox<Message> outbox(n);
  const mixloop::Bytes bytes = outbox.encode();
  return {bytes.begin(), bytes.end()};
}

lcm_t* connect() {
  lcm_t* lcm = lcm_create(kUrl);
  if (lcm == nullptr) std::exit(3);
  return lcm;
}

void ignore(const lcm_recv_buf_t*, const char*, void*) {}

struct Answer {
  lcm_t* lcm;
  const char* channel;
  std::vector<std::uint8_t> bytes;
};

void send_answer(const lcm_recv_buf_t*, const char*, void* context) {
  auto& a = *static_cast<Answer*>(context);
  lcm_publish(a.lcm, a.channel, a.bytes.data(), static_cast<unsigned>(a.bytes.size()));
}

/// Runs a peer in a child process and returns when it is listening.
pid_t start_peer(const char* answers_on, const std::vector<std::uint8_t>& bytes, const char* also_hears) {
  int ready[2];
  if (pipe(ready) != 0) std::exit(3);
  const pid_t child = fork();
  if (child != 0) {
    char byte;
    if (read(ready[0], &byte, 1) != 1) std::exit(3);
    return child;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Answer answer{connect(), answers_on, bytes};
  if (also_hears != nullptr) lcm_subscribe(answer.lcm, also_hears, ignore, nullptr);
  lcm_subscribe(answer.lcm, "BARE_STATE", send_answer, &answer);
  if (write(ready[1], "!", 1) != 1) std::exit(3);
  while (lcm_handle(answer.lcm) == 0) {
  }
  std::exit(3);
}

void count(const lcm_recv_buf_t*, const char*, void* counter) { ++*static_cast<long*>(counter); }

}  // namespace

int main(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 5000;
  const int n = argc > 2 ? std::atoi(argv[2]) : 3;
  alarm(120);  // a lost datagram leaves everybody waiting

  const pid_t peers[] = {
      start_peer("BARE_REFERENCE", bytes_of_blank<mixloop::reference_t>(n), nullptr),
      start_peer("BARE_COMMAND", bytes_of_blank<mixloop::command_t>(n), "BARE_REFERENCE"),
  };
  lcm_t* lcm = connect();
  long commands = 0;
  lcm_subscribe(lcm, "BARE_COMMAND", count, &commands);
  const auto state = bytes_of_blank<mixloop::state_t>(n);

  mixloop::Histogram round_trip;
  mixloop::Instant start{0}, arrived{0};
  for (long k = 0; k < kWarmUp + ticks; ++k) {
    const mixloop::Instant sent = mixloop::now();
    if (k == kWarmUp) start = sent;
    lcm_publish(lcm, "BARE_STATE", state.data(), static_cast<unsigned>(state.size()));
    while (commands <= k) lcm_handle(lcm);
    arrived = mixloop::now();
    if (k >= kWarmUp) round_trip.add(arrived - sent);
  }
  for (const pid_t peer : peers) {
    kill(peer, SIGKILL);
    waitpid(peer, nullptr, 0);
  }
  const auto seconds = [](mixloop::nanoseconds t) { return std::chrono::duration<double>(t).count(); };
  std::printf(
      R"({"ticks": %ld, "rate": %.1f, "round_trip_p50": %.9f, "round_trip_p99": %.9f, "round_trip_max": %.9f})"
      "\n",
      ticks, static_cast<double>(ticks) / seconds(arrived - start), seconds(round_trip.quantile(0.5)),
      seconds(round_trip.quantile(0.99)), seconds(round_trip.max()));
}
