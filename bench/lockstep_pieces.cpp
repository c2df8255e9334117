// SPDX-License-Identifier: MIT
// What our lockstep adds to the bare exchange, piece by piece: the table beside lockstep_pairs.
#include <benchmark/benchmark.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/histogram.hpp"
#include "runtime/protocol/session.hpp"

namespace {

using namespace mixloop;
constexpr int kN = 3;

template <class Message>
void encode(benchmark::State& loop) {
  Outbox<Message> outbox(kN);
  for (auto _ : loop) {
    ++outbox.message.seq;
    benchmark::DoNotOptimize(outbox.encode().data());
  }
}
BENCHMARK(encode<state_t>);
BENCHMARK(encode<reference_t>);
BENCHMARK(encode<command_t>);
BENCHMARK(encode<truth_t>);

template <class Message>
void check_and_decode(benchmark::State& loop) {
  Outbox<Message> outbox(kN);
  Inbox<Message> inbox(kN);
  const Bytes bytes = outbox.encode();
  for (auto _ : loop) benchmark::DoNotOptimize(inbox.read(bytes));
}
BENCHMARK(check_and_decode<state_t>);
BENCHMARK(check_and_decode<reference_t>);
BENCHMARK(check_and_decode<command_t>);

void read_the_clock(benchmark::State& loop) {
  for (auto _ : loop) benchmark::DoNotOptimize(now());
}
BENCHMARK(read_the_clock);

void add_to_the_histogram(benchmark::State& loop) {
  Histogram h;
  for (auto _ : loop) {
    h.add(nanoseconds(57'000));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(add_to_the_histogram);

void follow_the_session(benchmark::State& loop) {
  SessionFollower f(0);
  for (auto _ : loop) {
    const Instant at = now();
    benchmark::DoNotOptimize(f.would_follow(7, at) && f.follow(7, {}, at));
  }
}
BENCHMARK(follow_the_session);

// The one system call that ours has and the bare exchange has not: a ppoll before LCM's read, for deadlines
// and signals.
void poll_what_is_ready(benchmark::State& loop) {
  const int ready = eventfd(1, 0), stop = eventfd(0, 0);
  const timespec timeout{.tv_sec = 1, .tv_nsec = 0};
  for (auto _ : loop) {
    pollfd fds[] = {{.fd = ready, .events = POLLIN, .revents = 0},
                    {.fd = stop, .events = POLLIN, .revents = 0}};
    benchmark::DoNotOptimize(ppoll(fds, 2, &timeout, nullptr));
  }
  close(ready);
  close(stop);
}
BENCHMARK(poll_what_is_ready);

}  // namespace

BENCHMARK_MAIN();
