// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// Finds how a scene's closures hold: puts its mechanism together at home, from the guesses; finds which rows
/// follow from others, in which blocks the coordinates without a formula are solved one after the other, and
/// which of them follow linearly, so that these have a formula from then on. The scene's blocks, steps,
/// redundant_rows, size and its coordinates' `home` say so afterwards. Of a scene `from_starts` no formula is
/// looked for.
///
/// Throws InputError: "underconstrained", "overconstrained", "cannot_assemble", "ambiguous_branch",
/// "singular_home", "moves_nothing".
void assemble(Scene& scene);

/// Throws InputError("cannot_assemble") where the closures don't hold at home for these parameters on the
/// branch of the defaults.
void check_assembled(const Scene& scene, const std::vector<double>& parameters);

/// One way in which the mechanism can be put together at home.
struct Branch {
  std::vector<double> q;     ///< m: all dependent coordinates, solved angles within half a turn of the guess
  double from_guess = 0;     ///< of the solved coordinates: angles in rad, lengths over the scene's size
  double residual = 0;       ///< the largest of the rows, m or rad
  int iterations = 0;        ///< until it was found
  bool is_singular = false;  ///< a way that is left at no rate
};

/// Those that a scene's guesses and `seeds` random ones about them find, by their distance from the guess,
/// for a scene as read_scene gave it. Throws InputError for a distance of nothing.
std::vector<Branch> branches(const Scene& scene, int seeds);

}  // namespace mixloop
