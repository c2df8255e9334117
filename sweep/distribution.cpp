// SPDX-License-Identifier: MIT
#include "sweep/distribution.hpp"

#include "sweep/normal_quantile.hpp"

namespace mixloop {

double Distribution::quantile(double p) const {
  if (kind == Kind::normal) return first + second * normal_quantile(p);
  return first * (1 - p) + second * p;
}

}  // namespace mixloop
