// SPDX-License-Identifier: MIT
// What energy does: it stays where nothing takes it, and changes by the motors' work where they act.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <ctime>
#include <limits>

#include "dynamics/equations.hpp"
#include "loop/simulate.hpp"
#include "loop/truth.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {
namespace {

/// The paper's robot let go at home: no torque, no friction, 5 kg in its hand. A tick is a step.
class FreeRobot {
 public:
  explicit FreeRobot(double h)
      : scene_(papers_robot()),
        energies_(equations_of(scene_, Evaluation::machine_code, {Purpose::energy}),
                  scene_->default_parameters()),
        plant_({equations_of(scene_, Evaluation::machine_code, {Purpose::forward_dynamics}),
                scene_->default_parameters()},
               {}, 1 / h, scene_->home) {
    plant_.command(std::array<double, 3>{});
  }

  void step() { plant_.advance(); }
  /// Kinetic and potential.
  std::array<double, 2> energy() {
    std::array<double, 2> parts{};
    energies_.evaluate(Purpose::energy, {.psi = plant_.psi(), .psid = plant_.psid()}, parts);
    return parts;
  }
  std::string text() const { return text_of("psi", plant_.psi()) + "; " + text_of("psid", plant_.psid()); }

 private:
  SharedScene scene_;
  Equations::Workspace energies_;
  Plant plant_;
};

struct Drift {
  double relative = 0;  ///< the largest |E - E_0| over the largest kinetic energy
  double cpu = 0;       ///< s
};

Drift drift_over(double seconds, double h, Figure* figure) {
  FreeRobot robot(h);
  const auto start = robot.energy();
  double most_kinetic = 0, most = 0;
  const auto begun = std::clock();
  const auto steps = static_cast<std::int64_t>(std::llround(seconds / h)),
             stride = std::max<std::int64_t>(1, steps / 100000);
  for (std::int64_t k = 1; k <= steps; ++k) {
    robot.step();
    if (k % stride != 0 && k > 1000) continue;
    const auto [kinetic, potential] = robot.energy();
    const double change = std::abs(kinetic - start[0] + (potential - start[1]));
    most_kinetic = std::max(most_kinetic, kinetic);
    most = std::isfinite(change) ? std::max(most, change) : HUGE_VAL;
    if (figure != nullptr && k * 10 > steps)
      figure->look(most / most_kinetic,
                   [&] { return fmt::format("t = {} s, {}", static_cast<double>(k) * h, robot.text()); });
  }
  return {most / most_kinetic, static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC};
}

// Of a method of order p, the error of the energy in a step is a smooth function of the state times h^(p+1)
// and mostly of one sign: over T it grows at most like T h^p. A pilot of 100 s at twice the step tells its
// size there; the bound is that growth, with 4 for the motion's being another later on, and the walk of the
// rounding: each step rounds 6 numbers to eps/2, which changes the energy by up to 4 eps of the largest
// kinetic energy a step.
TEST(EnergyDrift, WithoutFrictionGrowsNoFasterThanTheMethodsErrorDoes) {
  const double seconds = full_length() ? 1e6 : 200, h = 1e-3;
  const double pilot = drift_over(100, 2 * h, nullptr).relative / 16;
  const double bound = 4 * pilot * seconds / 100 + 4 * kEps * std::sqrt(seconds / h);
  Figure figure("energy_drift", "of the largest kinetic energy", bound, 90000);
  const Drift drift = drift_over(seconds, h, &figure);
  figure.note(fmt::format("{:.3g} s by rk4 at {:.3g} ms: {:.3g} s of CPU time", seconds, 1e3 * h, drift.cpu));
}

/// What a tick's energy balance misses: |dE - dW|, J, and the size of what it is the difference of.
struct Balance {
  double miss = 0, size = 0;
};

Balance balance(const Truth& before, const Truth& after, double weight) {
  const double change =
      (after.kinetic_energy - before.kinetic_energy) + (after.potential_energy - before.potential_energy);
  return {
      std::abs(change - (after.work - before.work)),
      after.kinetic_energy + before.kinetic_energy + weight + std::abs(after.work) + std::abs(before.work)};
}

/// sum m |g| (reach + |P|): the size of the terms of the potential energy; springs count by what they hold.
double weight_of(const Scene& scene, const std::vector<double>& parameters) {
  const auto shared = std::make_shared<const Scene>(scene);
  const auto model = make_model<double>(shared, std::span<const double>(parameters));
  double sum = 0;
  for (const auto& body : model.bodies) {
    double reach = body.center_of_mass.norm();
    for (int at = body.frame; at != 0; at = model.links[static_cast<std::size_t>(at - 1)].parent) {
      const auto& link = model.links[static_cast<std::size_t>(at - 1)];
      reach += std::abs(link.a) + std::abs(link.s) + (link.prismatic ? 1 : 0);
    }
    sum += body.mass * model.gravity.norm() * reach;
  }
  return sum;
}

std::vector<Override> substeps(int count) { return {{"plant.substeps", fmt::format("{}", count)}}; }

/// The balances of all ticks of an experiment.
std::vector<Balance> balances_of(const std::string& file, int count) {
  const Experiment experiment = load_experiment(std::string(MIXLOOP_EXPERIMENTS "/") + file, substeps(count));
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  const Recorder& recorder = run.recorder();
  TruthReader reader(experiment, recorder);
  const double weight = weight_of(*experiment.scene, experiment.plant_parameters);
  std::vector<Balance> all;
  for (std::int64_t k = 0; k + 1 < recorder.ticks_recorded(); ++k) {
    const Truth before = reader.at(k);
    all.push_back(balance(before, reader.at(k + 1), weight));
  }
  return all;
}

/// A robot of a scene under torques drawn anew at each tick.
std::vector<Balance> balances_of(const SharedScene& scene, std::uint64_t seed, int ticks, int count) {
  const auto parameters = scene->default_parameters();
  const auto n = static_cast<std::size_t>(scene->n());
  std::mt19937_64 random(seed);
  Ruler ruler(scene, parameters);
  State state{uniform(random, scene->n(), 0.5), std::vector<double>(n, 0.0), {}};
  const Sizes sizes = ruler.sizes_at(state);
  Plant plant({equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics}), parameters},
              {.substeps = count}, 1000, state.psi);
  Equations::Workspace energies(equations_of(scene, Evaluation::interpreter, {Purpose::energy}), parameters);
  const double weight = weight_of(*scene, parameters);
  const auto truth = [&] {
    std::array<double, 2> parts{};
    energies.evaluate(Purpose::energy, {.psi = plant.psi(), .psid = plant.psid(), .t = plant.time()}, parts);
    Truth at;
    at.kinetic_energy = parts[0], at.potential_energy = parts[1], at.work = plant.work();
    return at;
  };
  std::vector<Balance> all;
  Truth before = truth();
  for (int k = 0; k < ticks; ++k) {
    auto tau = uniform(random, scene->n(), 1);
    for (std::size_t i = 0; i < n; ++i) tau[i] *= sizes.h[static_cast<Eigen::Index>(i)];
    plant.command(tau);
    plant.advance();
    const Truth after = truth();
    all.push_back(balance(before, after, weight + std::abs(after.potential_energy)));
    before = after;
  }
  return all;
}

/// Looks at the ticks with 16 steps each; `coarse`, with one, tell what the method's error leaves: it falls
/// by 16 at each halving (order 4), by 16^4 in all, of which 16 is left as a margin.
void look(Figure& figure, const std::vector<Balance>& coarse, const std::vector<Balance>& fine,
          const std::string& name) {
  double left = 0;
  for (const Balance& tick : coarse) left = std::max(left, tick.miss / 4096);
  for (std::size_t k = 0; k < fine.size(); ++k)
    figure.look(fine[k].miss / (kEps * fine[k].size + left), [&] {
      return fmt::format("{}, tick {}: {:.3g} J; with one step a tick up to {:.3g} J", name, k, fine[k].miss,
                         left * 4096);
    });
}

// E and W are sums of products of rounded numbers. T = psi' M psi' / 2 carries psi''s and M's rounding, V the
// angles', each within a few of kMostUnits' 64 eps; 16 steps add up 16 rounded increments of W and of psi'.
constexpr double kMostOfBalance = kMostUnits + 32;

TEST(PowerBalance, ChangesTheEnergyByTheMotorsWorkAtEveryTickOfTheExperiments) {
  Figure figure("power_balance", "eps x energy", kMostOfBalance, 12000);
  for (const char* file : {"paper.yaml", "no_payload.yaml", "fast_line.yaml", "there_and_back.yaml"}) {
    look(figure, balances_of(file, 1), balances_of(file, 16), file);
    if (!full_length()) break;
  }
}

TEST(PowerBalanceRandom, ChangesTheEnergyByTheMotorsWorkAtEveryTickOfRandomMechanisms) {
  const std::int64_t seeds = length(3, 100);
  const int ticks = static_cast<int>(length(50, 500));
  Figure figure("power_balance_random", "eps x energy", kMostOfBalance, seeds * ticks);
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    const auto which = static_cast<std::uint64_t>(seed);
    const SharedScene scene = conservative_scene(which);
    look(figure, balances_of(scene, which, ticks, 1), balances_of(scene, which, ticks, 16),
         fmt::format("seed {}", seed));
  }
}

}  // namespace
}  // namespace mixloop::stress
