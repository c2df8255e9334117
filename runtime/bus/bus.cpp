// SPDX-License-Identifier: MIT
#include "runtime/bus/bus.hpp"

#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <thread>
#include <vector>

#include "notation/errors.hpp"
#include "runtime/bus/channel_filter.hpp"
#include "runtime/bus/multicast_route.hpp"

namespace mixloop {
namespace {

struct Subscription {
  std::string channel;
  Bus::Handler handler;
  void* context;
};

/// A core that waits awake leaves its other half the way, and spares power.
void breathe() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// As liblcm's, for those that watch the bus.
constexpr const char* kSelfTest = "LCM_SELF_TEST";

}  // namespace

/// liblcm sends, a receiver of our own hears: liblcm's is a thread and a pipe more, and fragments break it.
struct Bus::Connection {
  explicit Connection(const std::string& url) : group(multicast_group(url)) {
    require_multicast_route(group);
    lcm = lcm_create(url.c_str());
    if (lcm == nullptr) throw RunFault("bus", "LCM cannot open " + url);
  }
  ~Connection() { lcm_destroy(lcm); }

  int fd() const { return receiver ? receiver->fd() : -1; }
  void listen();
  bool hears_itself();
  bool handle(const Received& message) const;
  std::vector<sock_filter> filter() const;

  MulticastGroup group;
  lcm_t* lcm = nullptr;
  std::optional<Receiver> receiver;
  std::vector<Subscription> subscriptions;
};

std::vector<sock_filter> Bus::Connection::filter() const {
  std::vector<std::string> channels;
  for (const Subscription& s : subscriptions) channels.push_back(s.channel);
  return channel_filter(channels);
}

/// To what is subscribed, from now on.
void Bus::Connection::listen() {
  if (!receiver) {
    const std::string test = kSelfTest;
    receiver.emplace(group, channel_filter(std::span(&test, 1)));
    if (!hears_itself())
      throw RunFault("bus",
                     "joined " + group.address +
                         " but heard not even what was sent from here: does a firewall drop multicast?");
  }
  receiver->set_filter(filter());
}

bool Bus::Connection::hears_itself() {
  for (int attempt = 0; attempt < 10; ++attempt) {
    lcm_publish(lcm, kSelfTest, "lcm self test", 14);
    pollfd fd{receiver->fd(), POLLIN, 0};
    if (poll(&fd, 1, 100) > 0 && receiver->next() != nullptr) return true;
  }
  return false;
}

/// Whether somebody waits for it.
bool Bus::Connection::handle(const Received& message) const {
  bool heard = false;
  for (const Subscription& subscription : subscriptions) {
    if (subscription.channel != message.channel) continue;
    subscription.handler(subscription.context, message);
    heard = true;
  }
  return heard;
}

Bus::Bus(BusOptions options)
    : options_(std::move(options)),
      connection_(std::make_unique<Connection>(options_.url)),
      has_cores_(std::thread::hardware_concurrency() > 1) {}

Bus::~Bus() = default;

void Bus::publish(const std::string& channel, Bytes bytes) {
  if (lcm_publish(connection_->lcm, channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) != 0)
    ++failed_sends_;
}

void Bus::subscribe(const std::string& channel, Handler handler, void* context) {
  connection_->subscriptions.push_back({channel, handler, context});
  connection_->listen();
}

void Bus::unsubscribe(const std::string& channel) {
  Connection& c = *connection_;
  const auto found = std::find_if(c.subscriptions.begin(), c.subscriptions.end(),
                                  [&channel](const Subscription& s) { return s.channel == channel; });
  if (found == c.subscriptions.end()) return;
  c.subscriptions.erase(found);
  c.listen();
}

std::uint64_t Bus::dropped() const {
  const auto& receiver = connection_->receiver;
  return receiver ? receiver->dropped_by_kernel() + receiver->malformed() : 0;
}

/// Hands on a message where there is one that somebody waits for.
bool Bus::take() {
  if (!connection_->receiver) return false;
  const Received* message = connection_->receiver->next();
  return message != nullptr && connection_->handle(*message);
}

void Bus::expect_answer() {
  if (!has_cores_ || options_.spin) return;
  if (luck_ < 0 && ++luck_ < 0) return;
  awake_until_ = now() + kMoment;
}

/// Nothing where none came until then.
std::optional<Wake> Bus::wait_awake(Instant until, Instant deadline, const StopSwitch& stop) {
  for (;;) {
    if (stop.turned()) return Wake::stop;
    if (take()) return Wake::message;
    const Instant at = now();
    if (at >= deadline) return Wake::deadline;
    if (at >= until) return std::nullopt;
    breathe();
  }
}

/// Nothing where none came in that moment.
std::optional<Wake> Bus::wait_for_answer(Instant deadline, const StopSwitch& stop) {
  const auto wake = wait_awake(*awake_until_, deadline, stop);
  if (wake == Wake::message) luck_ = std::min(luck_ + 1, kMostLuck);
  if (wake) return wake;
  awake_until_.reset();
  if (--luck_ <= 0) luck_ = kNoLuck;
  return std::nullopt;
}

void Bus::wait_out(Instant due, const StopSwitch& stop) const {
  if (!options_.spin) return sleep_until(due);
  while (now() < due && !stop.turned()) breathe();
}

Wake Bus::wait(Instant deadline, const StopSwitch& stop) {
  if (options_.spin) return *wait_awake(Instant::max(), deadline, stop);
  if (awake_until_)
    if (const auto wake = wait_for_answer(deadline, stop)) return *wake;
  pollfd fds[] = {{.fd = connection_->fd(), .events = POLLIN, .revents = 0},
                  {.fd = stop.fd(), .events = POLLIN, .revents = 0}};
  for (;;) {
    const nanoseconds left = std::max(deadline - now(), nanoseconds(0));
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec timeout{.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
    const int ready = ppoll(fds, 2, &timeout, nullptr);
    if (ready < 0 && errno != EINTR) throw RunFault("bus", "waiting for messages failed");
    if (stop.turned()) return Wake::stop;
    if (ready > 0 && fds[0].revents != 0 && take()) return Wake::message;
    if (ready == 0) return Wake::deadline;
  }
}

}  // namespace mixloop
