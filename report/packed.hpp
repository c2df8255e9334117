// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace mixloop {

/// Numbers as a page holds them: bit patterns as differences from the one before, byte planes one after the
/// other (all lowest bytes first), deflated (zlib), base64. web/shared/unpack.js undoes it.
std::string packed(std::span<const float> values);
/// The same of bit patterns.
std::string packed(std::span<const std::uint32_t> patterns);

}  // namespace mixloop
