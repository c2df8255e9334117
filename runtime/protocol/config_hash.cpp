// SPDX-License-Identifier: MIT
#include "runtime/protocol/config_hash.hpp"

#include <vector>

#include "notation/sha256.hpp"

namespace mixloop {

std::uint16_t hash16(std::string_view canonical) {
  return static_cast<std::uint16_t>(std::stoul(sha256_hex(canonical).substr(0, 4), nullptr, 16));
}

std::int64_t config_of(const std::array<std::string, 4>& common_ground) {
  const auto& [rate, mechanism, path, parameters] = common_ground;
  return pack({hash16(rate), hash16(mechanism), hash16(path), hash16(parameters)});
}

std::int64_t pack(const ConfigHash& hash) {
  return static_cast<std::int64_t>(std::uint64_t{hash.rate} << 48 | std::uint64_t{hash.mechanism} << 32 |
                                   std::uint64_t{hash.path} << 16 | std::uint64_t{hash.parameters});
}

ConfigHash unpack_config(std::int64_t config) {
  const auto bits = static_cast<std::uint64_t>(config);
  return {.rate = static_cast<std::uint16_t>(bits >> 48),
          .mechanism = static_cast<std::uint16_t>(bits >> 32),
          .path = static_cast<std::uint16_t>(bits >> 16),
          .parameters = static_cast<std::uint16_t>(bits)};
}

std::string name_difference(std::int64_t mine, std::int64_t theirs) {
  const ConfigHash a = unpack_config(mine), b = unpack_config(theirs);
  std::vector<std::string> names;
  if (a.rate != b.rate) names.emplace_back("rate");
  if (a.mechanism != b.mechanism) names.emplace_back("mechanism");
  if (a.path != b.path) names.emplace_back("path");
  if (a.parameters != b.parameters) names.emplace_back("shared parameters");

  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace mixloop
