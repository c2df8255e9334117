// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "dynamics/symbolic/harmonic_writing.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {

/// The equations of motion that follow from a harmonic energy, in one way of writing them down. `atoms` are
/// the energy's. Used while a Recording lives.
std::unique_ptr<Tracer> harmonic_equations(const Scene& scene, std::shared_ptr<const HarmonicScene> found,
                                           const Writing& writing, std::vector<Expression> atoms);

}  // namespace mixloop
