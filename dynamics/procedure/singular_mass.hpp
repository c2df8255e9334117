// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "dynamics/procedure/model.hpp"

namespace mixloop {

/// Why M has no inverse at psi (n) and t, naming the independent coordinates whose motion no inertia resists
/// and the bodies that they move; nothing where it has one. However unlike the units and sizes of its rows
/// are: an element of the diagonal is nothing beside what its bodies could weigh, an eigenvalue of the rest
/// beside its diagonal.
std::optional<std::string> why_mass_is_singular(const Model<double>& model, std::span<const double> psi,
                                                double t);

/// Throws InputError("singular_mass") where that is so at home and wherever it was looked about it, at t = 0.
void require_inertia(const std::shared_ptr<const Scene>& scene, const std::vector<double>& parameters);

}  // namespace mixloop
