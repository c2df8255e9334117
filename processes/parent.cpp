// SPDX-License-Identifier: MIT
#include "processes/parent.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>

namespace mixloop {

void die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) kill(getpid(), SIGKILL);  // it died before the line above
}

}  // namespace mixloop
