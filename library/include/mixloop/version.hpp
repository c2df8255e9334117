// SPDX-License-Identifier: MIT
#pragma once

#include <mixloop/api.hpp>

namespace mixloop::v1 {

/// Of the library that runs, e.g. "0.1.0".
MIXLOOP_API const char* version() noexcept;

}  // namespace mixloop::v1
