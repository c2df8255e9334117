// SPDX-License-Identifier: MIT
#include "tests/oracles/in_wide.hpp"

namespace mixloop {

template Model<Wide> make_model(const std::shared_ptr<const Scene>&, WideSpan);
template const Mat<Wide>& mass_matrix(const Model<Wide>&, WideSpan, const Wide&, Workspace<Wide>&);
template const Vec<Wide>& bias(const Model<Wide>&, WideSpan, WideSpan, const Wide&, Workspace<Wide>&);
template const Vec<Wide>& inverse_dynamics(const Model<Wide>&, WideSpan, WideSpan, WideSpan, const Wide&,
                                           Workspace<Wide>&);
template const Vec<Wide>& forward_dynamics(const Model<Wide>&, WideSpan, WideSpan, WideSpan, const Wide&,
                                           Workspace<Wide>&);
template const EndEffectorState<Wide>& end_effector(const Model<Wide>&, WideSpan, WideSpan, WideSpan,
                                                    const Wide&, Workspace<Wide>&);
template Energy<Wide> energy(const Model<Wide>&, WideSpan, WideSpan, const Wide&, Workspace<Wide>&);

namespace oracle {

template MultiplierSolution<Wide> multiplier_forward_dynamics(const Tree<Wide>&, const ConstraintState<Wide>&,
                                                              const VectorX<Wide>&);

}  // namespace oracle
}  // namespace mixloop
