// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"
#include "runtime/protocol/config_hash.hpp"

namespace mixloop {

/// What an experiment has of rate, mechanism, path and shared parameters, for who is told of a difference.
ConfigWords config_words(const Experiment& experiment);

}  // namespace mixloop
