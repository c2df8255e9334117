// SPDX-License-Identifier: MIT
#include "dynamics/assembly/assemble.hpp"

#include <fmt/format.h>

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
#include "notation/words.hpp"

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
                                 joined(open_closures(closing, x, closing.home_psi()))));
  throw InputError("cannot_assemble", place,
                   fmt::format("at home the mechanism can't be put together: at the nearest, {} stay open. "
                               "Expected other lengths, or a home that is within reach",
                               joined(open_closures(closing, x, closing.home_psi()))));
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
  // As far as a little is: beside a singular pose another way is as near, on which other rows don't hold.
  constexpr std::array kMoves{0.02, 0.002, 2e-4};
  Seeded seeded(11);
  for (int trial = 0; trial < 3; ++trial) {
    Vector direction = closing.home_psi();
    for (int i = 0; i < direction.size(); ++i)
      direction[i] =
          seeded.draw() *
          (closing.scene().independent[static_cast<std::size_t>(i)].linear ? closing.scene().size : 1);
    std::vector<std::string> open;
    for (double by : kMoves) {
      Vector moved = x;
      const Vector psi = closing.home_psi() + by * direction;
      if (!settle(closing, solved, moved, psi).closes) continue;
      open = open_closures(closing, moved, psi);
      if (open.empty()) break;
    }
    if (!open.empty())
      throw InputError(
          "overconstrained", closing.scene().closures.front().place,
          fmt::format("where the motors move, {} don't close: they hold what is to move. Expected "
                      "fewer closures, or more coordinates",
                      joined(open)));
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
  return "{" + joined(texts) + "}";
}

/// Whether all rows hold at home, those that were left aside included.
bool closes(Closing& closing, const Vector& x) {
  return closing.residual(closing.whole(), x, closing.home_psi()).cwiseAbs().maxCoeff() < 1e-11;
}

/// A way to put all blocks together, one after the other.
struct Together {
  Vector x;
  double squared = HUGE_VAL;  ///< its distance from the guess
  /// A block, and two ways of it that are about as near; one is taken.
  struct Alike {
    const Closing::Part* block;
    Vector one, other;
  };
  std::vector<Alike> alike = {};
};

/// The nearest to the guess of all ways of all blocks: where one block's nearest leads the next ones nowhere,
/// or far away, another of its ways may be nearer in all.
class NearestWay {
 public:
  NearestWay(Closing& closing, const std::vector<Closing::Part>& blocks, const Vector& guess)
      : closing_(closing), blocks_(blocks), guess_(guess) {}

  /// Not finite where there is none.
  const Together& from(const Vector& x) {
    go_on(0, {x, 0, {}});
    return best_;
  }

 private:
  void go_on(std::size_t b, const Together& so_far) {
    if (!(so_far.squared < best_.squared)) return;
    if (b == blocks_.size()) {
      if (closes(closing_, so_far.x)) best_ = so_far;
      return;
    }
    const auto ways = ways_of(closing_, blocks_[b], so_far.x, guess_, seeds_for(blocks_[b]));
    for (std::size_t i = 0; i < ways.size(); ++i) {
      Together next = so_far;
      next.squared += ways[i].from_guess * ways[i].from_guess;
      for (int u : blocks_[b].unknowns) next.x[u] = ways[i].x[u];
      const std::size_t other = i == 0 ? 1 : i - 1;
      if (other < ways.size() && ways[i].from_guess > 1e-9 && about_as_near(ways[i], ways[other]))
        next.alike.push_back({&blocks_[b], ways[std::min(i, other)].x, ways[std::max(i, other)].x});
      go_on(b + 1, next);
    }
  }

  static bool about_as_near(const Found& a, const Found& b) {
    return std::max(a.from_guess, b.from_guess) <= 1.1 * std::min(a.from_guess, b.from_guess);
  }

  Closing& closing_;
  const std::vector<Closing::Part>& blocks_;
  const Vector& guess_;
  Together best_;
};

void take_nearest(Closing& closing, const std::vector<Closing::Part>& blocks, const Vector& guess,
                  Vector& x) {
  const Together nearest = NearestWay(closing, blocks, guess).from(x);
  if (!std::isfinite(nearest.squared)) refuse(closing, x);
  if (!nearest.alike.empty()) {
    const auto& [block, one, other] = nearest.alike.front();
    throw InputError("ambiguous_branch", closing.scene().closures.front().place,
                     fmt::format("two ways to put the mechanism together at home are about as near to the "
                                 "guess {}: {} and {}. Expected a guess nearer to one of them, under home",
                                 pose_text(closing, *block, guess), pose_text(closing, *block, one),
                                 pose_text(closing, *block, other)));
  }
  x = nearest.x;
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
