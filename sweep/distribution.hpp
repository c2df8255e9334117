// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace mixloop {

/// What a varied number is drawn from.
struct Distribution {
  enum class Kind : std::uint8_t { normal, uniform };

  Kind kind = Kind::uniform;
  double first = 0, second = 1;  ///< mean and standard deviation, or from and to

  /// The value below which a share p of the drawn ones lies, 0 < p < 1.
  double quantile(double p) const;
};

}  // namespace mixloop
