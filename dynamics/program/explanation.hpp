// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamics/program/trace.hpp"

namespace mixloop {

/// What a scene's programs skip, and why.
struct Explanation {
  struct Quantity {
    Purpose purpose;
    OperationCount literal;  ///< of the procedure as it stands
    OperationCount run;      ///< of the program
    OperationCount set_up;   ///< of what runs when a parameter changes
    Tracing tracing;
    bool compiled = true;  ///< false: too long, interpreted
  };

  std::vector<Quantity> quantities;
  std::vector<std::string> reasons;  ///< sentences, in words of mechanics
};

Explanation explain(const std::shared_ptr<const Scene>& scene);

/// The reasons alone; see Explanation.
std::vector<std::string> reasons_of(const std::shared_ptr<const Scene>& scene);

}  // namespace mixloop
