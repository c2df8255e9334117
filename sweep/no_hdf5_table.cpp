// SPDX-License-Identifier: MIT
// Where there is no HDF5 to build with.
#include <stdexcept>

#include "sweep/table.hpp"

namespace mixloop {

bool has_hdf5() { return false; }

void write_hdf5(const std::filesystem::path&, const Sweep&, const EachRun&) {
  throw std::logic_error("built without HDF5");
}

}  // namespace mixloop
