// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace mixloop {

/// Operations of a straight-line piece. A sine and a cosine of one angle count as one pair; a change of
/// sign counts as an addition.
struct OperationCount {
  std::size_t add = 0, mul = 0, div = 0, sqrt = 0, sincos = 0, other = 0;
  std::size_t fused = 0;  ///< of the sums and products, so many are one operation (fma)

  /// Everything but the sine/cosine pairs.
  std::size_t flops() const { return add + mul + div + sqrt + other; }
  /// Of so many pieces alike.
  OperationCount times(std::size_t pieces) const {
    return {add * pieces,    mul * pieces,   div * pieces,  sqrt * pieces,
            sincos * pieces, other * pieces, fused * pieces};
  }
  /// `85 add + 64 mul + 1 div + 3 sincos, 52 fused`.
  std::string text() const;
};

}  // namespace mixloop
