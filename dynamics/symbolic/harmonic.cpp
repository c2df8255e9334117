// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/tracer.hpp"
namespace mixloop {
std::unique_ptr<Tracer> harmonic_tracer(std::shared_ptr<const Scene>) { return nullptr; }
}  // namespace mixloop
