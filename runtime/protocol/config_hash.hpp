// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace mixloop {

/// What plant, controller and planner must have in common, each as 16 bits of a hash, so that a mismatch on
/// the wire can be named.
struct ConfigHash {
  std::uint16_t rate = 0;        ///< ticks a second
  std::uint16_t mechanism = 0;   ///< n and the scene
  std::uint16_t path = 0;        ///< path, profile, duration
  std::uint16_t parameters = 0;  ///< run-time parameters that both sides share

  bool operator==(const ConfigHash&) const = default;
};

/// The first 16 bits of the SHA-256 of a canonical text (same meaning, same text).
std::uint16_t hash16(std::string_view canonical);

/// The messages' `config` field of what is common, canonical texts of rate, mechanism, path and parameters.
std::int64_t config_of(const std::array<std::string, 4>& common_ground);

/// The messages' `config` field: rate in the highest 16 bits, then mechanism, path, parameters.
std::int64_t pack(const ConfigHash& hash);
ConfigHash unpack_config(std::int64_t config);

/// Names what differs, as "rate and path"; empty where nothing does.
std::string name_difference(std::int64_t mine, std::int64_t theirs);

/// What one process has of each part of the config, in words for people; may be empty.
using ConfigWords = std::array<std::string, 4>;

/// What differs, with the hashes of both sides and the words of this one:
/// "rate is 1000 Hz here (hash 0001), there another (hash 0002)".
std::string describe_difference(std::int64_t mine, std::int64_t theirs, const ConfigWords& words);

}  // namespace mixloop
