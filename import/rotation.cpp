// SPDX-License-Identifier: MIT
#include "import/rotation.hpp"

#include <cmath>
#include <numbers>

namespace mixloop {
namespace {

struct CosSin {
  double c = 1, s = 0;
};

CosSin cos_sin(double angle) {
  const double quarters = std::round(angle / (std::numbers::pi / 2));
  if (std::abs(quarters) > 4 || angle != quarters * (std::numbers::pi / 2))
    return {std::cos(angle), std::sin(angle)};
  constexpr std::array<CosSin, 4> kRight = {CosSin{1, 0}, CosSin{0, 1}, CosSin{-1, 0}, CosSin{0, -1}};
  return kRight[static_cast<std::size_t>(static_cast<int>(quarters) + 4) % 4];
}

}  // namespace

Eigen::Matrix3d rotation_of(const Triple& rpy) {
  const auto [cr, sr] = cos_sin(rpy[0]);
  const auto [cp, sp] = cos_sin(rpy[1]);
  const auto [cy, sy] = cos_sin(rpy[2]);
  Eigen::Matrix3d X, Y, Z;
  X << 1, 0, 0, 0, cr, -sr, 0, sr, cr;
  Y << cp, 0, sp, 0, 1, 0, -sp, 0, cp;
  Z << cy, -sy, 0, sy, cy, 0, 0, 0, 1;
  return Z * Y * X;
}

}  // namespace mixloop
