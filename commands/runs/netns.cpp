// SPDX-License-Identifier: MIT
// A command in a network namespace of its own, where LCM's multicast goes over the loopback alone: nothing
// that it sends can leave this machine.
#include <fcntl.h>
#include <fmt/format.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <cstring>

#include "commands/commands.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

[[noreturn]] void fail(const std::string& what) {
  const int cause = errno;
  throw RunFault(
      "no_namespace",
      fmt::format("{}: {}; as root it needs CAP_SYS_ADMIN, else user namespaces "
                  "(sysctl kernel.unprivileged_userns_clone=1 user.max_user_namespaces=1000). Or, as "
                  "root, in this network: ip link set lo up; ip route add 224.0.0.0/4 dev lo",
                  what, std::strerror(cause)));
}

void write_own(const char* file, const std::string& text) {
  const int fd = open(file, O_WRONLY | O_CLOEXEC);
  if (fd < 0 || write(fd, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    fail(std::string("cannot write ") + file);
  close(fd);
}

/// Who isn't root becomes it, in a user namespace where nobody else is.
void enter_namespace() {
  const auto user = geteuid();
  const auto group = getegid();
  if (unshare(user == 0 ? CLONE_NEWNET : CLONE_NEWUSER | CLONE_NEWNET) != 0) fail("no network namespace");
  if (user == 0) return;
  write_own("/proc/self/setgroups", "deny");
  write_own("/proc/self/uid_map", fmt::format("0 {} 1", user));
  write_own("/proc/self/gid_map", fmt::format("0 {} 1", group));
}

sockaddr address(in_addr_t value) {
  sockaddr_in internet{};
  internet.sin_family = AF_INET;
  internet.sin_addr.s_addr = htonl(value);
  sockaddr plain{};
  std::memcpy(&plain, &internet, sizeof plain);
  return plain;
}

/// ip link set lo up; ip route add 224.0.0.0/4 dev lo
void route_multicast_over_loopback() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  char name[IFNAMSIZ] = "lo";
  ifreq loopback{};
  std::memcpy(loopback.ifr_name, name, sizeof name);
  loopback.ifr_flags = IFF_UP;
  if (fd < 0 || ioctl(fd, SIOCSIFFLAGS, &loopback) != 0) fail("cannot bring the loopback up");
  rtentry route{};
  route.rt_dst = address(0xE0000000);
  route.rt_genmask = address(0xF0000000);
  route.rt_flags = RTF_UP;
  route.rt_dev = name;
  if (ioctl(fd, SIOCADDRT, &route) != 0) fail("cannot add a multicast route");
  close(fd);
}

int run(const std::vector<std::string>& words) {
  enter_namespace();
  route_multicast_over_loopback();
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  throw InputError("no_such_command", {},
                   fmt::format("cannot start '{}': {}", words.front(), std::strerror(errno)));
}

}  // namespace

void add_netns_command(CLI::App& command, int& status) {
  auto words = std::make_shared<std::vector<std::string>>();
  command.prefix_command();
  command.footer(
      "Nothing that the command sends leaves this machine, and nothing from outside reaches it. Needs no "
      "root.\n"
      "Examples:\n"
      "  mixloop netns mixloop run experiments/paper.yaml --speed 1\n"
      "  mixloop netns sh        # a shell there, to start the processes by hand\n"
      "To look on from another terminal, with the PID of what runs there:\n"
      "  nsenter --preserve-credentials --user --net --target PID mixloop monitor");
  command.callback([&command, words, &status] {
    *words = command.remaining();
    if (words->empty())
      throw InputError("command_line", {},
                       "netns: no command; expected one to run, e.g. mixloop netns mixloop run EXPERIMENT");
    status = run(*words);
  });
}

}  // namespace mixloop
