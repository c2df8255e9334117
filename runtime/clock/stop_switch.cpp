// SPDX-License-Identifier: MIT
#include "runtime/clock/stop_switch.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <stdexcept>
#include <system_error>

namespace mixloop {
namespace {

std::atomic<StopSwitch*> signal_switch{nullptr};
constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, kSignals.size()> previous;

extern "C" void turn_signal_switch(int signal) {
  const int saved = errno;
  if (StopSwitch* s = signal_switch.load()) s->turn(signal);
  errno = saved;
}

}  // namespace

StopSwitch::StopSwitch() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

StopSwitch::~StopSwitch() {
  if (has_signals_) {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &previous[i], nullptr);
    signal_switch = nullptr;
  }
  close(fd_);
}

void StopSwitch::turn_on_signals() {
  StopSwitch* nobody = nullptr;
  if (!signal_switch.compare_exchange_strong(nobody, this))
    throw std::logic_error("another StopSwitch already has this process's signals");
  has_signals_ = true;
  struct sigaction action {};
  action.sa_handler = turn_signal_switch;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &previous[i]);
    const bool is_to_outlive = kSignals[i] == SIGHUP && previous[i].sa_handler == SIG_IGN;
    if (!is_to_outlive) sigaction(kSignals[i], &action, nullptr);
  }
}

void StopSwitch::turn(int signal) noexcept {
  signal_ = signal;
  turned_ = true;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof one);
}

}  // namespace mixloop
