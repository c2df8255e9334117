// SPDX-License-Identifier: MIT
#include "sweep/sobol.hpp"

#include <bit>
#include <boost/random/sobol.hpp>
#include <stdexcept>

namespace mixloop {
namespace {

using Tables = boost::random::default_sobol_table;

}  // namespace

// v_j = 2^-j m_j, m_j = 2 a_1 m_(j-1) xor ... xor 2^s m_(j-s) xor m_(j-s), by a primitive polynomial
// x^s + a_1 x^(s-1) + ... + 1; of the first dimension m_j = 1.
Sobol::Sobol(std::size_t dimensions, const Chance& chance) : chance_(chance), directions_(dimensions) {
  if (dimensions > kMostDimensions) throw std::invalid_argument("more dimensions than Sobol's sequence has");
  for (std::size_t dimension = 0; dimension < dimensions; ++dimension) {
    const std::uint64_t polynomial = dimension == 0 ? 1 : Tables::polynomial(dimension - 1);
    const unsigned degree = static_cast<unsigned>(std::bit_width(polynomial)) - 1;
    std::array<std::uint64_t, kBits> m{};
    for (unsigned j = 0; j < kBits; ++j) {
      if (dimension == 0) {
        m[j] = 1;
      } else if (j < degree) {
        m[j] = Tables::minit(dimension - 1, j);
      } else {
        m[j] = m[j - degree];
        for (unsigned i = 1; i <= degree; ++i)
          if ((polynomial >> (degree - i)) & 1) m[j] ^= m[j - i] << i;
      }
      directions_[dimension][j] = m[j] << (kBits - 1 - j);
    }
  }
}

double Sobol::at(std::int64_t index, std::size_t dimension) const {
  std::uint64_t point = 0;
  for (std::uint64_t rest = static_cast<std::uint64_t>(index), j = 0; rest != 0; rest >>= 1, ++j)
    if (rest & 1) point ^= directions_[dimension][j];
  std::uint64_t scrambled = 0;
  for (unsigned bit = 0; bit < kBits; ++bit) {
    const auto before = static_cast<std::int64_t>(point >> (kBits - bit));
    const std::uint64_t flip = chance_.bits(before, dimension * 64 + bit, Draw::scramble) >> 63;
    scrambled |= (((point >> (kBits - 1 - bit)) & 1) ^ flip) << (kBits - 1 - bit);
  }
  return 0x1p-52 * (static_cast<double>(scrambled) + 0.5);
}

}  // namespace mixloop
