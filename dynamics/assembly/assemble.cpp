// SPDX-License-Identifier: MIT
#include "dynamics/assembly/assemble.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dynamics/assembly/linear_blocks.hpp"
#include "dynamics/assembly/seeded.hpp"
#include "dynamics/assembly/settle.hpp"
#include "dynamics/assembly/starts.hpp"
#include "dynamics/assembly/steps.hpp"
#include "dynamics/assembly/structure.hpp"
#include "dynamics/procedure/decompositions.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

/// "'loop 1' (2.3 mm)" of the closures that are open by more than round-off.
std::vector<std::string> open_closures(Closing& closing, const Vector& x, const Vector& psi) {
  const auto whole = closing.whole();
  const Vector r = closing.residual(whole, x, psi);
  std::vector<std::string> texts;
  for (std::size_t c = 0; c < closing.scene().closures.size(); ++c) {
    double most = 0;
    bool length = false;
    for (int i = 0; i < closing.rows(); ++i) {
      if (closing.row(i).closure != static_cast<int>(c)) continue;
      most = std::max(most, std::abs(r[i]) * closing.unit_of_row(i));
      length = closing.is_length(i);
    }
    if (!(most < 1e-11))
      texts.push_back(fmt::format("{} (by {:.3g} {})", in_quotes(closing.scene().closures[c].name), most,
                                  length ? "m" : "rad"));
  }
  return texts;
}

/// Why no pose closes at home.
[[noreturn]] void refuse(Closing& closing, Vector x) {
  Closing::Part part = closing.whole();
  const auto kept = independent_rows(closing.slopes(part, x, closing.home_psi()));
  const Place& place = closing.scene().closures.front().place;
  part.rows = kept;
  if (static_cast<int>(kept.size()) < closing.rows() && settle(closing, part, x, closing.home_psi()).closes)
    throw InputError("overconstrained", place,
                     fmt::format("the closures contradict each other: with as many of them as there are "
                                 "coordinates without a formula, {} stay open. Expected fewer closures, or "
                                 "more coordinates",
                                 fmt::join(open_closures(closing, x, closing.home_psi()), ", ")));
  throw InputError("cannot_assemble", place,
                   fmt::format("at home the mechanism can't be put together: at the nearest, {} stay open. "
                               "Expected other lengths, or a home that is within reach",
                               fmt::join(open_closures(closing, x, closing.home_psi()), ", ")));
}

/// From the guess, or where that leads nowhere, from places about it.
void put_together(Closing& closing, Vector& x) {
  constexpr int kStarts = 24;
  constexpr std::array kReach{0.05, 0.2, 0.6};
  const Vector guess = x;
  Vector nearest = x;
  Seeded seeded(13);
  for (int start = 0; start <= kStarts; ++start) {
    x = guess;
    if (start > 0)
      for (auto& value : x) value += kReach[static_cast<std::size_t>(start) % kReach.size()] * seeded.draw();
    if (settle(closing, closing.whole(), x, closing.home_psi()).closes) return;
    if (start == 0) nearest = x;
  }
  refuse(closing, nearest);
}

/// All closures hold beside home, too, where the motors move a little and the blocks are solved.
void refuse_held_motors(Closing& closing, const std::vector<Closing::Part>& blocks, const Vector& x) {
  Closing::Part solved;
  for (const auto& block : blocks) {
    solved.unknowns.insert(solved.unknowns.end(), block.unknowns.begin(), block.unknowns.end());
    solved.rows.insert(solved.rows.end(), block.rows.begin(), block.rows.end());
  }
  Seeded seeded(11);
  for (int trial = 0; trial < 3; ++trial) {
    Vector moved = x, psi = closing.home_psi();
    for (int i = 0; i < psi.size(); ++i)
      psi[i] += 0.02 * seeded.draw() *
                (closing.scene().independent[static_cast<std::size_t>(i)].linear ? closing.scene().size : 1);
    if (!settle(closing, solved, moved, psi).closes) continue;
    const auto open = open_closures(closing, moved, psi);
    if (!open.empty())
      throw InputError(
          "overconstrained", closing.scene().closures.front().place,
          fmt::format("where the motors move, {} don't close: they hold what is to move. Expected "
                      "fewer closures, or more coordinates",
                      fmt::join(open, ", ")));
  }
}

struct Found {
  Vector x;
  double from_guess;
  Settled settled;
};

/// The ways in which a block closes at home, the nearest to the guess first.
std::vector<Found> ways_of(Closing& closing, const Closing::Part& block, const Vector& x, const Vector& guess,
                           int seeds) {
  Seeded far(7), near(8);
  std::vector<Found> found;
  // All about, and half as many near the guess again: of two ways that nearly meet the nearer one is hard to
  // hit.
  for (int seed = 0; seed <= seeds + seeds / 2; ++seed) {
    Vector from = x;
    for (int u : block.unknowns) {
      from[u] = guess[u];
      if (seed > seeds)
        from[u] += near.draw() * (seed % 2 == 0 ? 0.1 : 0.4);
      else if (seed > 0)
        from[u] += far.draw() * (closing.turns(u) ? std::numbers::pi : 1.5);
    }
    const Settled settled = settle(closing, block, from, closing.home_psi());
    if (!settled.closes) continue;
    const auto known = std::find_if(found.begin(), found.end(), [&](const Found& other) {
      return apart(closing, block, other.x, from) < 1e-6;
    });
    if (known != found.end()) continue;
    unwind(closing, from, guess);
    found.push_back({from, apart(closing, block, from, guess), settled});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.from_guess < b.from_guess; });
  return found;
}

int seeds_for(const Closing::Part& block) {
  return std::min<int>(64, 8 * (static_cast<int>(block.unknowns.size()) + 1));
}

std::string pose_text(const Closing& closing, const Closing::Part& block, const Vector& x) {
  std::vector<std::string> texts;
  for (int u : block.unknowns) {
    const auto& name = closing.scene().coordinates[static_cast<std::size_t>(closing.coordinate(u))].name;
    texts.push_back(closing.turns(u) ? fmt::format("{}: {:.4g} deg", name, x[u] * 180 / std::numbers::pi)
                                     : fmt::format("{}: {:.4g} m", name, x[u] * closing.unit_of_unknown(u)));
  }
  return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

/// Of each block, one after the other, the way nearest to the guess.
void take_nearest(Closing& closing, const std::vector<Closing::Part>& blocks, const Vector& guess,
                  Vector& x) {
  for (const auto& block : blocks) {
    const auto ways = ways_of(closing, block, x, guess, seeds_for(block));
    if (ways.empty()) refuse(closing, x);
    if (ways.size() > 1 && ways[0].from_guess > 1e-9 && ways[1].from_guess <= 1.1 * ways[0].from_guess)
      throw InputError("ambiguous_branch", closing.scene().closures.front().place,
                       fmt::format("two ways to put the mechanism together at home are about as near to the "
                                   "guess {}: {} and {}. Expected a guess nearer to one of them, under home",
                                   pose_text(closing, block, guess), pose_text(closing, block, ways[0].x),
                                   pose_text(closing, block, ways[1].x)));
    for (int u : block.unknowns) x[u] = ways[0].x[u];
  }
}

void refuse_no_length(Scene& scene) {
  Closing closing(scene, scene.default_parameters());
  for (auto& closure : scene.closures) {
    if (closure.kind != Scene::Closure::Kind::distance) continue;
    closure.home_length = std::abs(closing.value_at(closure.value, closing.home(), closing.home_psi()));
    if (!(closure.home_length > 1e-9 * scene.size))
      throw InputError("out_of_range", closure.value.place,
                       fmt::format("the closure {} keeps a distance of {:.3g} m at home; expected a length, "
                                   "or 'coincide' where two points are one",
                                   in_quotes(closure.name), closure.home_length));
  }
}

void put_home(Scene& scene, Closing& closing, const Vector& x) {
  const std::vector<double> q = closing.coordinates(x, closing.home_psi());
  for (std::size_t j = 0; j < q.size(); ++j) scene.coordinates[j].home = q[j];
}

/// Each motor has to move some transform's coordinate.
void refuse_motors_that_move_nothing(const Scene& scene, Closing& closing, const Vector& x) {
  std::vector<ClosedPose> poses = poses_about(closing, x, 2);
  poses.push_back({x, closing.home_psi()});
  std::vector<bool> moves(static_cast<std::size_t>(scene.n()), false);
  for (const auto& pose : poses) {
    const Matrix C = closing.rates(pose.x, pose.psi);
    for (const auto& transform : scene.transforms)
      for (int i = 0; transform.coordinate && i < scene.n(); ++i)
        if (std::abs(C(*transform.coordinate, i)) > 1e-9) moves[static_cast<std::size_t>(i)] = true;
  }
  for (int i = 0; i < scene.n(); ++i)
    if (!moves[static_cast<std::size_t>(i)])
      throw InputError("moves_nothing", scene.closures.front().place,
                       "'" + scene.independent[static_cast<std::size_t>(i)].name +
                           "' moves nothing: no transform varies with it, directly, by a formula or through "
                           "the closures");
}

}  // namespace

void assemble(Scene& scene) {
  if (scene.closures.empty()) return;
  scene.size = size_of(scene);
  refuse_no_length(scene);
  Closing closing(scene, scene.default_parameters());
  const Vector guess = closing.home();
  Vector x = guess;
  put_together(closing, x);
  Structure structure = structure_of(closing, x);
  x = guess;
  take_nearest(closing, structure.blocks, guess, x);
  if (!(closing.residual(closing.whole(), x, closing.home_psi()).cwiseAbs().maxCoeff() < 1e-11))
    refuse(closing, x);
  structure = structure_of(closing, x);
  refuse_held_motors(closing, structure.blocks, x);
  refuse_motors_that_move_nothing(scene, closing, x);
  put_home(scene, closing, x);
  for (int row : structure.redundant) scene.redundant_rows.push_back(closing.row(row));
  const std::vector<bool> is_linear = scene.from_starts ? std::vector<bool>(structure.blocks.size(), false)
                                                        : linear_blocks(scene, closing, structure.blocks, x);
  put_steps(scene, closing, structure.blocks, is_linear);
  find_starts(scene);
}

void check_assembled(const Scene& scene, const std::vector<double>& parameters) {
  if (!scene.is_closed()) return;
  const std::vector<double> defaults = scene.default_parameters();
  Vector x, at;
  constexpr int kSteps = 16;
  for (int k = 0; k <= kSteps; ++k) {
    std::vector<double> between = parameters;
    for (std::size_t i = 0; k < kSteps && i < between.size(); ++i)
      between[i] = defaults[i] + (parameters[i] - defaults[i]) * k / kSteps;
    Closing closing(scene, between);
    if (k == 0) x = closing.home();
    at = x;
    if (!settle(closing, closing.whole(), x, closing.home_psi()).closes) refuse(closing, x);
    if (apart(closing, closing.whole(), x, at) > 0.5)
      throw InputError("cannot_assemble", scene.closures.front().place,
                       "the way from the defaults leads through a singular pose at home: which branch is "
                       "meant is not known. Expected these numbers as the scene's own");
  }
}

std::vector<Branch> branches(const Scene& scene, int seeds) {
  std::vector<Branch> found;
  if (scene.closures.empty()) return found;
  Scene sized = scene;
  sized.size = size_of(scene);
  refuse_no_length(sized);
  Closing closing(sized, sized.default_parameters());
  const Closing::Part whole = closing.whole();
  const Vector psi = closing.home_psi();
  for (const auto& way : ways_of(closing, whole, closing.home(), closing.home(), seeds)) {
    Branch branch;
    branch.q = closing.coordinates(way.x, psi);
    branch.from_guess = way.from_guess;
    const Vector rows = closing.residual(whole, way.x, psi);
    for (int i = 0; i < closing.rows(); ++i)
      branch.residual = std::max(branch.residual, std::abs(rows[i]) * closing.unit_of_row(i));
    branch.iterations = way.settled.iterations;
    branch.is_singular =
        static_cast<int>(independent_rows(closing.slopes(whole, way.x, psi)).size()) < closing.unknowns();
    found.push_back(std::move(branch));
  }
  return found;
}

}  // namespace mixloop
