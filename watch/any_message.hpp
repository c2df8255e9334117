// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "mixloop_lcm/fields.hpp"
#include "runtime/bus/wire.hpp"

namespace mixloop {

/// Decodes a message of any of our types, known by its fingerprint, into `kept`; keeps what that has
/// allocated where it holds this type already. False: it is none of ours, or its length isn't what its n
/// claims.
bool decode(Bytes bytes, AnyMessage& kept);

/// "state_t" and so on; "" for none.
std::string_view type_name(const AnyMessage& message);

}  // namespace mixloop
