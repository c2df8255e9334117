// SPDX-License-Identifier: MIT
// Of a build without NLopt: whoever asks can_minimise first gets to say so.
#include <stdexcept>

#include "tuning/minimise.hpp"

namespace mixloop {

bool can_minimise() { return false; }

void look_around(const Minimisation&, std::size_t, int) { throw std::logic_error("built without NLopt"); }

void go_down(const Minimisation&, const std::vector<double>&, double, double) {
  throw std::logic_error("built without NLopt");
}

}  // namespace mixloop
