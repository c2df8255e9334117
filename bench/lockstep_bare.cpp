// SPDX-License-Identifier: MIT
// The floor under lockstep: three processes exchange its messages over plain LCM, with nothing computed,
// checked, encoded or decoded. Plant: STATE, then wait for COMMAND. Planner: REFERENCE for every STATE.
// Controller: COMMAND for every STATE.
//   lockstep_bare [TICKS [N [RATE]]]
// With a RATE in Hz STATE is sent by an absolute clock, and all three take real-time rights as `mixloop run
// --realtime` does: the floor under real time.
#include <lcm/lcm.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/histogram.hpp"
#include "runtime/machine/real_time_rights.hpp"

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

volatile std::sig_atomic_t asked_to_leave = 0;

/// Runs a peer in a child process and returns when it is listening.
pid_t start_peer(const char* answers_on, const std::vector<std::uint8_t>& bytes, const char* also_hears,
                 bool real_time) {
  int ready[2];
  if (pipe(ready) != 0) std::exit(3);
  const pid_t child = fork();
  if (child != 0) {
    char byte;
    if (read(ready[0], &byte, 1) != 1) std::exit(3);
    return child;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  struct sigaction leave {};  // without SA_RESTART: it ends a read
  leave.sa_handler = [](int) { asked_to_leave = 1; };
  sigaction(SIGTERM, &leave, nullptr);
  Answer answer{connect(), answers_on, bytes};
  if (also_hears != nullptr) lcm_subscribe(answer.lcm, also_hears, ignore, nullptr);
  lcm_subscribe(answer.lcm, "BARE_STATE", send_answer, &answer);
  if (real_time) mixloop::take_real_time_rights({});
  if (write(ready[1], "!", 1) != 1) std::exit(3);
  while (!asked_to_leave && lcm_handle(answer.lcm) == 0) {
  }
  std::exit(asked_to_leave ? 0 : 3);
}

void count(const lcm_recv_buf_t*, const char*, void* counter) { ++*static_cast<long*>(counter); }

}  // namespace

int main(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 5000;
  const int n = argc > 2 ? std::atoi(argv[2]) : 3;
  const double rate = argc > 3 ? std::atof(argv[3]) : 0;
  alarm(120);  // a lost datagram leaves everybody waiting

  const pid_t peers[] = {
      start_peer("BARE_REFERENCE", bytes_of_blank<mixloop::reference_t>(n), nullptr, rate > 0),
      start_peer("BARE_COMMAND", bytes_of_blank<mixloop::command_t>(n), "BARE_REFERENCE", rate > 0),
  };
  lcm_t* lcm = connect();
  long commands = 0;
  lcm_subscribe(lcm, "BARE_COMMAND", count, &commands);
  const auto state = bytes_of_blank<mixloop::state_t>(n);
  if (rate > 0) mixloop::take_real_time_rights({});

  mixloop::Histogram round_trip;
  mixloop::Instant start{0}, arrived{0};
  const mixloop::Instant begin = mixloop::now();
  for (long k = 0; k < kWarmUp + ticks; ++k) {
    if (rate > 0)
      mixloop::sleep_until(begin + mixloop::nanoseconds(std::llround(1e9 * static_cast<double>(k) / rate)));
    const mixloop::Instant sent = mixloop::now();
    if (k == kWarmUp) start = sent;
    lcm_publish(lcm, "BARE_STATE", state.data(), static_cast<unsigned>(state.size()));
    while (commands <= k) lcm_handle(lcm);
    arrived = mixloop::now();
    if (k >= kWarmUp) round_trip.add(arrived - sent);
  }
  for (const pid_t peer : peers) {
    do {  // again where it came just before a read
      kill(peer, SIGTERM);
      usleep(1000);
    } while (waitpid(peer, nullptr, WNOHANG) == 0);
  }
  const auto seconds = [](mixloop::nanoseconds t) { return std::chrono::duration<double>(t).count(); };
  std::printf(
      R"({"ticks": %ld, "rate": %.1f, "round_trip_p50": %.9f, "round_trip_p99": %.9f, "round_trip_max": %.9f})"
      "\n",
      ticks, static_cast<double>(ticks) / seconds(arrived - start), seconds(round_trip.quantile(0.5)),
      seconds(round_trip.quantile(0.99)), seconds(round_trip.max()));
}
