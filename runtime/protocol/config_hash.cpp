// SPDX-License-Identifier: MIT
#include "runtime/protocol/config_hash.hpp"

#include <fmt/format.h>

#include <vector>

#include "notation/sha256.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

struct Part {
  const char* name;
  std::uint16_t ConfigHash::*hash;
};
constexpr std::array kParts = {Part{"rate", &ConfigHash::rate}, Part{"mechanism", &ConfigHash::mechanism},
                               Part{"path", &ConfigHash::path},
                               Part{"shared parameters", &ConfigHash::parameters}};

}  // namespace

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
  std::vector<std::string> names;
  for (const Part& part : kParts)
    if (unpack_config(mine).*part.hash != unpack_config(theirs).*part.hash) names.emplace_back(part.name);
  return enumerated(names);
}

std::string describe_difference(std::int64_t mine, std::int64_t theirs, const ConfigWords& words) {
  std::string text;
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const auto [name, hash] = kParts[i];
    const std::uint16_t here = unpack_config(mine).*hash, there = unpack_config(theirs).*hash;
    if (here == there) continue;
    text += fmt::format("{}{} is {} here (hash {:04x}), there another (hash {:04x})",
                        text.empty() ? "" : "; ", name, words[i].empty() ? "one" : words[i], here, there);
  }
  return text;
}

}  // namespace mixloop
