// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// With what and on what a result came about: what its bytes and its times depend on.
struct Origin {
  std::string mixloop, compiler, c_library, eigen;  ///< versions
  std::string processor, kernel;
  unsigned cores = 0;
};

Origin origin_here();

}  // namespace mixloop
