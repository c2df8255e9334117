// SPDX-License-Identifier: MIT
// The procedure and the multipliers in the wide float, compiled once for all tests: each takes a compiler
// long.
#pragma once

#include "dynamics/procedure/procedure.hpp"
#include "tests/oracles/multipliers.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop {

using oracle::Wide;
using WideSpan = std::span<const Wide>;

extern template Model<Wide> make_model(const std::shared_ptr<const Scene>&, WideSpan);
extern template const Mat<Wide>& mass_matrix(const Model<Wide>&, WideSpan, const Wide&, Workspace<Wide>&);
extern template const Vec<Wide>& bias(const Model<Wide>&, WideSpan, WideSpan, const Wide&, Workspace<Wide>&);
extern template const Vec<Wide>& inverse_dynamics(const Model<Wide>&, WideSpan, WideSpan, WideSpan,
                                                  const Wide&, Workspace<Wide>&);
extern template const Vec<Wide>& forward_dynamics(const Model<Wide>&, WideSpan, WideSpan, WideSpan,
                                                  const Wide&, Workspace<Wide>&);
extern template const EndEffectorState<Wide>& end_effector(const Model<Wide>&, WideSpan, WideSpan, WideSpan,
                                                           const Wide&, Workspace<Wide>&);
extern template Energy<Wide> energy(const Model<Wide>&, WideSpan, WideSpan, const Wide&, Workspace<Wide>&);

namespace oracle {

extern template MultiplierSolution<Wide> multiplier_forward_dynamics(const Tree<Wide>&,
                                                                     const ConstraintState<Wide>&,
                                                                     const VectorX<Wide>&);

}  // namespace oracle
}  // namespace mixloop
