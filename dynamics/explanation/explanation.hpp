// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/program/evaluation.hpp"
#include "dynamics/program/trace.hpp"

namespace mixloop {

/// What a scene's programs skip, and why.
struct Explanation {
  struct Quantity {
    Purpose purpose;
    OperationCount literal;  ///< of the procedure as it stands
    OperationCount run;      ///< of the program; of the procedure where it is too long to trace
    OperationCount set_up;   ///< of what runs when a parameter changes
    Tracing tracing;
    std::optional<Evaluation>
        evaluation;  ///< how it is evaluated here; none: a linearisation too long to trace
  };

  std::vector<Quantity> quantities;
  std::vector<std::string> reasons;  ///< sentences, in words of mechanics
};

Explanation explain(const std::shared_ptr<const Scene>& scene);

/// The reasons alone; see Explanation.
std::vector<std::string> reasons_of(const std::shared_ptr<const Scene>& scene);
/// Of them, how its closures are solved.
std::vector<std::string> closure_reasons(const std::shared_ptr<const Scene>& scene);

}  // namespace mixloop
