// SPDX-License-Identifier: MIT
#pragma once

#include "notation/keys.hpp"

namespace mixloop {

/// What may stand in an experiment's `path`.
const Keys& path_keys();

}  // namespace mixloop
