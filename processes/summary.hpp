// SPDX-License-Identifier: MIT
#pragma once

#include "loop/result.hpp"

namespace mixloop {

/// The summary that a person reads.
std::string summary(const Experiment& experiment, const Result& result);

/// What the bus adds to it; empty where it was none.
std::string bus_summary(const Result& result);

}  // namespace mixloop
