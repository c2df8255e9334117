// SPDX-License-Identifier: MIT
#pragma once

#include "notation/keys.hpp"

namespace mixloop {

/// What may stand in an experiment, in its `limits` and in what it expects.
const Keys& experiment_keys();
const Keys& limit_keys();
const Keys& expectation_keys();

}  // namespace mixloop
