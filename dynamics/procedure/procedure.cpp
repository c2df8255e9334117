// SPDX-License-Identifier: MIT
#include "dynamics/procedure/procedure.hpp"

namespace mixloop {

template class SmallSystem<double>;
template struct Workspace<double>;
template class detail::CoordinatesAlong<double>;
template Model<double> make_model(const std::shared_ptr<const Scene>&, std::span<const double>);
template void solve_closures(const Model<double>&, std::span<const double>, const double&,
                             Workspace<double>&);
template void coordinates(const Model<double>&, std::span<const double>, const double&, Workspace<double>&);
template void coordinate_rates(const Model<double>&, std::span<const double>, std::span<const double>,
                               const double&, Workspace<double>&);
template void frame_variations(const Model<double>&, Workspace<double>&);
template const Mat<double>& mass_matrix(const Model<double>&, std::span<const double>, const double&,
                                        Workspace<double>&);
template const Vec<double>& bias(const Model<double>&, std::span<const double>, std::span<const double>,
                                 const double&, Workspace<double>&);
template const Vec<double>& inverse_dynamics(const Model<double>&, std::span<const double>,
                                             std::span<const double>, std::span<const double>, const double&,
                                             Workspace<double>&);
template const Vec<double>& forward_dynamics(const Model<double>&, std::span<const double>,
                                             std::span<const double>, std::span<const double>, const double&,
                                             Workspace<double>&);
template const EndEffectorState<double>& end_effector(const Model<double>&, std::span<const double>,
                                                      std::span<const double>, std::span<const double>,
                                                      const double&, Workspace<double>&);
template Energy<double> energy(const Model<double>&, std::span<const double>, std::span<const double>,
                               const double&, Workspace<double>&);

}  // namespace mixloop
