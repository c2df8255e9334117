// SPDX-License-Identifier: MIT
// Random mechanisms whose chains close, against Lagrange multipliers on the tree that they are cut open to,
// and random trees that move freely, against multipliers on their joints: the programs, and the procedure in
// 113 bits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <random>
#include <thread>

#include "dynamics/equations.hpp"
#include "tests/oracles/closed_mechanism.hpp"
#include "tests/oracles/in_wide.hpp"
#include "tests/oracles/random_mechanism.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/support/free_ones.hpp"

namespace mixloop::stress {
namespace {

using oracle::ClosedMechanism;
using MechanismState = ClosedMechanism::State;
using WideVector = oracle::VectorX<Wide>;
using WideMatrix = oracle::MatrixX<Wide>;

WideVector widened(const std::vector<double>& x) {
  WideVector wide(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) wide[static_cast<Eigen::Index>(i)] = Wide(x[i]);
  return wide;
}

/// What the multipliers say at the mechanism's state.
struct Expected {
  WideMatrix M, slopes;  ///< of psi'' by psi, psi', tau
  WideVector h, psidd;
};

// Central differences: h^2 = 1e-22 of the third derivative, noise 1e-33 / h = 1e-22.
template <class Psidd>
WideMatrix differences(const Psidd& psidd, const WideVector& psi, const WideVector& psid,
                       const WideVector& tau, int n_u) {
  const Wide step(1e-11);
  const auto n = psi.size();
  WideMatrix slopes(n, 2 * n + n_u);
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    const auto at = [&](const Wide& by) {
      WideVector moved[] = {psi, psid, tau};
      moved[k / n][k % n] += by;
      return psidd(moved[0], moved[1], moved[2]);
    };
    slopes.col(k) = (at(step) - at(-step)) / (2 * step);
  }
  return slopes;
}

/// Nothing acts on what moves freely.
WideVector torques(const MechanismState& state, const Scene& scene) {
  WideVector tau = widened(state.input).head(scene.n());
  tau.tail(scene.n() - scene.n_u()).setZero();
  return tau;
}

/// By a mechanism's own tree; `home` is the pose that was put together, in all digits that a double has.
class Multipliers {
 public:
  Multipliers(const ClosedMechanism& mechanism, const Scene& scene)
      : mechanism_(mechanism),
        scene_(scene),
        home_psi_(widened(mechanism.home_psi())),
        home_(mechanism.pose()) {
    // Those that were found to be linear have a formula now.
    for (int j = 0; j < mechanism.m(); ++j)
      if (scene.coordinates[static_cast<std::size_t>(j)].is_solved() ||
          std::ranges::count(scene.linear, j) > 0)
        home_[j] = Wide(scene.coordinates[static_cast<std::size_t>(j)].home);
    is_closed_ = mechanism.close<Wide>(home_, home_psi_, Wide(0));
  }

  /// Whether the scene's home, on which the search for the state starts, closes the tree.
  bool is_closed() const { return is_closed_; }
  const WideVector& home() const { return home_; }

  /// False where the way to the state leads out of reach.
  bool look(Expected& expected) {
    const auto& state = mechanism_.state();
    const WideVector psi = widened(state.psi), psid = widened(state.psid);
    const WideVector tau = torques(state, scene_);
    const Wide t(state.t);
    q_ = home_;
    if (!mechanism_.follow<Wide>(q_, home_psi_, psi, t)) return false;
    const auto constraints = mechanism_.rates<Wide>(q_, psi, psid, t);
    const auto tree = mechanism_.tree<Wide>();
    const int n = mechanism_.n();
    expected.M = constraints.C.transpose() * oracle::tree_mass_matrix(tree, q_) * constraints.C;
    expected.h = oracle::multiplier_inverse_dynamics<Wide>(tree, constraints, WideVector::Zero(n));
    expected.psidd = psidd(psi, psid, tau, t);
    expected.slopes = differences(
        [&](const auto& at, const auto& rates, const auto& forces) { return psidd(at, rates, forces, t); },
        psi, psid, tau, scene_.n_u());
    return true;
  }

 private:
  WideVector psidd(const WideVector& psi, const WideVector& psid, const WideVector& tau, const Wide& t) {
    WideVector q = q_;
    if (!mechanism_.close<Wide>(q, psi, t)) return WideVector::Constant(psi.size(), Wide(NAN));
    return mechanism_.forward_dynamics<Wide>(mechanism_.rates<Wide>(q, psi, psid, t), psi, tau, t).psidd;
  }

  const ClosedMechanism& mechanism_;
  const Scene& scene_;
  WideVector home_psi_, home_, q_;
  bool is_closed_ = false;
};

/// What multipliers on its joints say of a random tree.
Expected expected_of(const oracle::RandomMechanism& mechanism, const MechanismState& state,
                     const Scene& scene) {
  const WideVector psi = widened(state.psi), psid = widened(state.psid), tau = torques(state, scene);
  const Wide t(state.t);
  const auto tree = mechanism.tree<Wide>(t);
  const auto constraints = mechanism.constraints<Wide>(psi, psid, t);
  const auto psidd = [&](const WideVector& at, const WideVector& rates, const WideVector& forces) {
    return WideVector(
        oracle::multiplier_forward_dynamics<Wide>(tree, mechanism.constraints<Wide>(at, rates, t), forces)
            .psidd);
  };
  return {.M = constraints.C.transpose() * oracle::tree_mass_matrix(tree, constraints.q) * constraints.C,
          .slopes = differences(psidd, psi, psid, tau, scene.n_u()),
          .h = oracle::multiplier_inverse_dynamics<Wide>(tree, constraints, WideVector::Zero(scene.n())),
          .psidd = psidd(psi, psid, tau)};
}

double difference(const auto& found, const auto& expected) {
  const double size = static_cast<double>(Wide(expected.cwiseAbs().maxCoeff()));
  const double apart = static_cast<double>(Wide((found - expected).cwiseAbs().maxCoeff()));
  return apart / std::max(size, 1.0);
}

/// The procedure in 113 bits: M, h and psi'', the worst relative difference.
double in_wide(const SharedScene& scene, const MechanismState& state, const Expected& expected) {
  std::vector<Wide> parameters;
  for (double value : scene->default_parameters()) parameters.emplace_back(value);
  const auto model = make_model<Wide>(scene, WideSpan(parameters));
  Workspace<Wide> ws(model);
  const auto wide = [](const std::vector<double>& x) { return std::vector<Wide>(x.begin(), x.end()); };
  const auto psi = wide(state.psi), psid = wide(state.psid), tau = wide(state.input);
  const Wide t(state.t);
  double worst = difference(mass_matrix<Wide>(model, psi, t, ws), expected.M);
  worst = std::max(worst, difference(bias<Wide>(model, psi, psid, t, ws), expected.h));
  return std::max(worst, difference(forward_dynamics<Wide>(model, psi, psid, tau, t, ws), expected.psidd));
}

constexpr auto kAll = {Purpose::mass_matrix, Purpose::bias, Purpose::forward_dynamics,
                       Purpose::linearisation};

WideMatrix expected_of(Purpose purpose, const Expected& expected) {
  if (purpose == Purpose::mass_matrix) return expected.M;
  if (purpose == Purpose::bias) return expected.h;
  return purpose == Purpose::forward_dynamics ? WideMatrix(expected.psidd) : expected.slopes;
}

/// Of every third mechanism all coordinates behind the first move freely.
std::string description_of(const ClosedMechanism& mechanism, std::uint64_t seed) {
  const std::string text = mechanism.scene_text();
  return seed % 3 == 0 && mechanism.n() > 1 ? with_free_ones(text, 1) : text;
}

/// Of every fifth seed a tree stands beside the mechanism that closes.
constexpr std::uint64_t kTrees = 5;

/// A tree that moves freely but for its first coordinate; nothing where it has no other.
class FreeTree {
 public:
  explicit FreeTree(std::uint64_t seed)
      : mechanism_(seed, {.nonlinear = seed % 3 == 0, .loads = seed % 2 == 0, .springs = seed % 4 == 0}) {
    if (mechanism_.n() < 2) return;
    scene_ = scene_of(with_free_ones(mechanism_.scene_text(), 1));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> pose(-0.5, 0.5), rate(-2, 2);
    for (int i = 0; i < mechanism_.n(); ++i) {
      state_.psi.push_back(pose(random));
      state_.psid.push_back(rate(random));
      state_.input.push_back(rate(random));
    }
  }
  const SharedScene& scene() const { return scene_; }
  const MechanismState& state() const { return state_; }
  Expected expected() const { return expected_of(mechanism_, state_, *scene_); }

 private:
  oracle::RandomMechanism mechanism_;
  SharedScene scene_;
  MechanismState state_;
};

/// Seeds may be looked at side by side.
class Comparison {
 public:
  Comparison()
      : programs_("closed_mechanisms", "relative", 1e-9, length(40, 1000) * 4),
        wide_("closed_mechanisms_wide", "relative", 1e-24, length(40, 1000)),
        // Constants that linear relations leave are known to a double's digits, in 113 bits too.
        wide_linear_("closed_mechanisms_linear", "relative", 1e-12, length(40, 1000)),
        trees_("closed_mechanisms_free_trees", "relative", 1e-9, length(40, 1000) / kTrees * 5) {}
  ~Comparison() {
    programs_.note(fmt::format(
        "{} compared, {} of them torn, {} too long to linearise, {} on another branch, {} ambiguous",
        static_cast<int>(compared_), static_cast<int>(torn_), static_cast<int>(too_long_),
        static_cast<int>(elsewhere_), static_cast<int>(ambiguous_)));
  }

  void look(std::uint64_t seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const ClosedMechanism mechanism(seed);
    SharedScene scene;
    try {
      scene = scene_of(description_of(mechanism, seed));
    } catch (const InputError& error) {
      // A guess that is off may lie between two ways to put the mechanism together.
      EXPECT_EQ(error.code, "ambiguous_branch") << error.message;
      ++ambiguous_;
      return;
    }
    Multipliers multipliers(mechanism, *scene);
    ASSERT_TRUE(multipliers.is_closed());
    if (!is_nearest(mechanism, multipliers)) return;
    Expected expected;
    ASSERT_TRUE(multipliers.look(expected));
    ++compared_;
    torn_ += scene->started_rates() > 0;
    take(scene->linear.empty() ? wide_ : wide_linear_, in_wide(scene, mechanism.state(), expected),
         fmt::format("seed {}", seed));
    compare(programs_, seed, mechanism.state(), scene, expected, Evaluation::interpreter);
    if (seed % (full_length() ? 50 : 20) == 1)
      compare(programs_, seed, mechanism.state(), scene, expected, Evaluation::machine_code);
  }

  void look_at_tree(std::uint64_t seed) {
    SCOPED_TRACE(fmt::format("tree of seed {}", seed));
    const FreeTree tree(seed);
    if (!tree.scene()) return;
    const Expected expected = tree.expected();
    take(wide_, in_wide(tree.scene(), tree.state(), expected), fmt::format("tree of seed {}", seed));
    compare(trees_, seed, tree.state(), tree.scene(), expected, Evaluation::interpreter);
  }

 private:
  void take(Figure& figure, double value, const std::string& where) {
    const std::lock_guard lock(figures_);
    figure.look(value, [&] { return where; });
  }

  /// Whether the pose that was drawn is the one that was put together. It must be no farther from the guess.
  bool is_nearest(const ClosedMechanism& mechanism, const Multipliers& multipliers) {
    double found = 0, drawn = 0, apart = 0;
    const auto pose = mechanism.pose();
    for (const auto& guess : mechanism.guesses()) {
      const double home = static_cast<double>(multipliers.home()[guess.coordinate]);
      found += std::pow(home - guess.value, 2), drawn += std::pow(pose[guess.coordinate] - guess.value, 2);
      apart = std::max(apart, std::abs(home - pose[guess.coordinate]));
    }
    if (apart < 1e-9) return true;
    ++elsewhere_;
    EXPECT_LT(found, drawn) << "another branch than the nearest";
    return false;
  }

  void compare(Figure& figure, std::uint64_t seed, const MechanismState& state, const SharedScene& scene,
               const Expected& expected, Evaluation how) {
    for (const Purpose purpose : kAll) {
      std::shared_ptr<const Equations> equations;
      try {
        equations = equations_of(scene, how, {purpose});
      } catch (const InputError& error) {
        EXPECT_EQ(error.code, "too_large") << error.message;
        ++too_long_;
        continue;
      }
      Equations::Workspace program(equations, scene->default_parameters());
      auto out = program.outputs(purpose);
      EXPECT_EQ(program.evaluate(purpose, {state.psi, state.psid, state.input, state.t}, out), Status::ok);
      const WideMatrix right = expected_of(purpose, expected);
      const WideMatrix found =
          Eigen::Map<const Eigen::MatrixXd>(out.data(), right.rows(), right.cols()).cast<Wide>();
      take(figure, difference(found, right), fmt::format("seed {}, {}", seed, name_of(purpose)));
    }
  }

  std::mutex figures_;
  Figure programs_, wide_, wide_linear_, trees_;
  std::atomic<int> compared_ = 0, torn_ = 0, too_long_ = 0, elsewhere_ = 0, ambiguous_ = 0;
};

TEST(ClosedMechanisms, AgreeWithLagrangeMultipliersOnTheTreeThatTheyAreCutOpenTo) {
  Comparison comparison;
  const auto last = static_cast<std::uint64_t>(length(40, 1000));
  std::atomic<std::uint64_t> next = 1;
  const auto work = [&] {
    for (std::uint64_t seed = next++; seed <= last; seed = next++) {
      comparison.look(seed);
      if (seed % kTrees == 0) comparison.look_at_tree(seed);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; full_length() && i < std::thread::hardware_concurrency(); ++i)
    others.emplace_back(work);
  work();
}

}  // namespace
}  // namespace mixloop::stress
