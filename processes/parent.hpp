// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

namespace mixloop {

/// From now on the kernel kills this process when `parent`, which started it, dies; at once where it has
/// died. What its parent asked for before the exec isn't enough: the kernel forgets that where the file has
/// capabilities, as `setcap cap_sys_nice` gives it for real time.
void die_with(pid_t parent);

}  // namespace mixloop
