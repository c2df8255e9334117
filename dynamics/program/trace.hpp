// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/procedure/purpose.hpp"
#include "dynamics/program/program.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// How a program's equations were written down.
enum class Tracing : std::uint8_t { literal, recursive, articulated, harmonic, inertial };
constexpr std::string_view name_of(Tracing tracing) {
  constexpr std::string_view kNames[] = {"literal", "recursive", "articulated", "harmonic", "inertial"};
  return kNames[static_cast<std::size_t>(tracing)];
}

/// A program and the way it was traced.
struct TracedProgram {
  Program program;
  Tracing tracing = Tracing::literal;
};

/// Nodes of a linearisation's graph at most, of another purpose's Graph::kMostNodes.
constexpr std::size_t kMostOfDerivatives = 8 << 20;

/// The program of a purpose by one way of tracing; an empty one (no outputs) where that way can't, or would
/// take more operations than a graph holds.
Program trace(const std::shared_ptr<const Scene>& scene, Purpose purpose, Tracing tracing);

/// The cheapest program that the tracers find for a purpose; an empty one where all take more operations than
/// a graph holds. The same scene gives the same program on
/// every machine: the choice goes by an estimate (see estimated_time), never by a clock.
TracedProgram trace(const std::shared_ptr<const Scene>& scene, Purpose purpose);

/// What is watched of a scene's closures at a pose, and from where they are solved next; an empty program
/// where that takes more operations than a graph holds. Its input is a start (start_size()); it gives
///   of each started coordinate the derivatives by psi (n) and by t,
///   all rows of the closures (m or rad), and of each solved angle by how much its cosine and sine are off
///   the unit circle, of each block |G| |G^-1| / k, Frobenius norms of the slopes with lengths in units of
///   the scene's size, the solution (start_size()), and the last corrections.
Program trace_closures(const std::shared_ptr<const Scene>& scene);

}  // namespace mixloop
