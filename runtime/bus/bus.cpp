// SPDX-License-Identifier: MIT
#include "runtime/bus/bus.hpp"

#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <list>
#include <mutex>
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
  lcm_subscription_t* in_lcm = nullptr;
};

void dispatch(const lcm_recv_buf_t* received, const char*, void* user) {
  const auto& subscription = *static_cast<Subscription*>(user);
  // LCM subtracts lengths that a stranger chose: a channel without an end makes a negative size.
  const bool sound = received->data_size <= 65536;
  subscription.handler(
      subscription.context,
      sound ? Bytes(static_cast<const std::uint8_t*>(received->data), received->data_size) : Bytes());
}

std::string quoted_as_regex(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    if (std::string_view("\\^$.|?*+()[]{}").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

// LCM opens its receiving socket at the first subscription and keeps it to itself: it is the one on the
// group's port that is new. Locked, so that two buses in one process don't take each other's.
std::mutex receiving_socket_search;

}  // namespace

struct Bus::Connection {
  explicit Connection(const std::string& url) : group(multicast_group(url)) {
    require_multicast_route(group);
    lcm = lcm_create(url.c_str());
    if (lcm == nullptr) throw RunFault("bus", "LCM cannot open " + url);
  }
  ~Connection() { lcm_destroy(lcm); }

  lcm_subscription_t* subscribe(Subscription& subscription);
  void narrow_filter();

  MulticastGroup group;
  lcm_t* lcm = nullptr;
  int fd = -1;
  int receiving_socket = -1;
  std::list<Subscription> subscriptions;  // LCM points into it
};

lcm_subscription_t* Bus::Connection::subscribe(Subscription& subscription) {
  const auto subscribe_in_lcm = [&] {
    return lcm_subscribe(lcm, quoted_as_regex(subscription.channel).c_str(), dispatch, &subscription);
  };
  if (fd >= 0) return subscribe_in_lcm();

  const std::lock_guard lock(receiving_socket_search);
  const std::vector<int> before = sockets_on_port(group.port);
  lcm_subscription_t* made = subscribe_in_lcm();
  if (made == nullptr) return nullptr;
  fd = lcm_get_fileno(lcm);
  const std::vector<int> after = sockets_on_port(group.port);
  std::vector<int> opened;
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::back_inserter(opened));
  if (opened.size() == 1) receiving_socket = opened.front();
  return made;
}

// Without a receiving socket to attach it to, everything works, only with more wake-ups.
void Bus::Connection::narrow_filter() {
  if (receiving_socket < 0) return;
  std::vector<std::string> channels;
  for (const Subscription& s : subscriptions) channels.push_back(s.channel);
  attach(receiving_socket, channel_filter(channels));
}

Bus::Bus(BusOptions options)
    : options_(std::move(options)), connection_(std::make_unique<Connection>(options_.url)) {}

Bus::~Bus() = default;

void Bus::publish(const std::string& channel, Bytes bytes) {
  if (lcm_publish(connection_->lcm, channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) != 0)
    ++failed_sends_;
}

void Bus::subscribe(const std::string& channel, Handler handler, void* context) {
  Connection& c = *connection_;
  Subscription& subscription =
      c.subscriptions.emplace_back(Subscription{.channel = channel, .handler = handler, .context = context});
  subscription.in_lcm = c.subscribe(subscription);
  if (subscription.in_lcm == nullptr)
    throw RunFault("bus", "LCM joined " + options_.url +
                              " but doesn't hear its own test message: does a firewall drop multicast?");
  // A full queue drops the newest message and keeps the oldest: make it longer than any backlog.
  lcm_subscription_set_queue_capacity(subscription.in_lcm, 100'000);
  c.narrow_filter();
}

void Bus::unsubscribe(const std::string& channel) {
  Connection& c = *connection_;
  const auto found = std::find_if(c.subscriptions.begin(), c.subscriptions.end(),
                                  [&channel](const Subscription& s) { return s.channel == channel; });
  if (found == c.subscriptions.end()) return;
  lcm_unsubscribe(c.lcm, found->in_lcm);
  c.subscriptions.erase(found);
  c.narrow_filter();
}

Wake Bus::wait(Instant deadline, const StopSwitch& stop) {
  pollfd fds[] = {{.fd = connection_->fd, .events = POLLIN, .revents = 0},
                  {.fd = stop.fd(), .events = POLLIN, .revents = 0}};
  for (;;) {
    const nanoseconds left = std::max(deadline - now(), nanoseconds(0));
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec timeout{.tv_sec = seconds.count(), .tv_nsec = (left - seconds).count()};
    const int ready = ppoll(fds, 2, &timeout, nullptr);
    if (ready < 0 && errno != EINTR) throw RunFault("bus", "waiting for messages failed");
    if (stop.turned()) return Wake::stop;
    if (ready > 0 && fds[0].revents != 0) {
      lcm_handle(connection_->lcm);
      return Wake::message;
    }
    if (ready == 0) return Wake::deadline;
  }
}

}  // namespace mixloop
