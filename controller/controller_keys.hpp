// SPDX-License-Identifier: MIT
#pragma once

#include "notation/keys.hpp"

namespace mixloop {

/// What may stand in an experiment's `controller`, in its `about` and in its `safety`.
const Keys& controller_keys();
const Keys& about_keys();
const Keys& safety_keys();

}  // namespace mixloop
