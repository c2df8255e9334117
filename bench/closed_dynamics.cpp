// SPDX-License-Identifier: MIT
// Forward dynamics of mechanisms whose chains close, by their closures and in the peers, which keep them by
// constraints: held to the procedure in 113 bits first, then timed interleaved; the least of many repeats
// counts.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>

#include "bench/closed_engine.hpp"
#include "bench/closed_pantograph.hpp"
#include "bench/machine.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "tests/oracles/in_wide.hpp"

namespace mixloop::bench {
namespace {

using Clock = std::chrono::steady_clock;
using oracle::Wide;
using ScenePtr = std::shared_ptr<const Scene>;
constexpr int kStates = 128;

std::vector<double> narrowed(const Vec<Wide>& x) {
  std::vector<double> numbers;
  for (const Wide& number : x) numbers.push_back(static_cast<double>(number));
  return numbers;
}

/// States on a walk through the pose space (each near the one before, so that all are on home's branch), and
/// what psi'' is there. Where the motors can't turn round they go to and fro about home, by up to `reach`,
/// and end where they began.
struct Known {
  std::vector<ClosedState> states;
  std::vector<std::vector<double>> psidd;
};

Known known_states(const ScenePtr& scene, double reach = 0) {
  std::vector<Wide> parameters;
  for (double value : scene->default_parameters()) parameters.emplace_back(value);
  const auto model = make_model<Wide>(scene, WideSpan(parameters));
  Workspace<Wide> ws(model);
  std::mt19937_64 random(20261127);
  std::uniform_real_distribution<double> step(0, 0.4), rate(-10, 10), torque(-5, 5);
  const auto n = static_cast<std::size_t>(scene->n());
  Known known;
  ClosedState state;
  state.psi = scene->home;
  for (int k = 0; k < kStates; ++k) {
    state.psid.assign(n, 0), state.tau.assign(static_cast<std::size_t>(scene->n_u()), 0);
    for (std::size_t i = 0; i < n; ++i)
      if (reach > 0)
        state.psi[i] = scene->home[i] +
                       reach * std::sin(2 * std::numbers::pi * k / kStates + static_cast<double>(2 * i));
      else
        state.psi[i] += step(random);
    for (double& x : state.psid) x = rate(random);
    for (double& x : state.tau) x = torque(random);
    const std::vector<Wide> psi(state.psi.begin(), state.psi.end()),
        psid(state.psid.begin(), state.psid.end()), tau(state.tau.begin(), state.tau.end());
    known.psidd.push_back(narrowed(forward_dynamics<Wide>(model, psi, psid, tau, Wide(0), ws)));
    state.q = narrowed(ws.q);
    state.qd =
        narrowed(Vec<Wide>(ws.C * Eigen::Map<const Vec<Wide>>(psid.data(), static_cast<Eigen::Index>(n))));
    known.states.push_back(state);
  }
  return known;
}

ClosedEngine ours(const ScenePtr& scene, Evaluation how, const std::string& by = "") {
  const auto dynamics = std::make_shared<Equations::Workspace>(
      equations_of(scene, how, {Purpose::forward_dynamics}), scene->default_parameters());
  const auto n = static_cast<std::size_t>(scene->n());
  return {"mixloop, " + std::string(name_of(dynamics->equations().evaluation())) + by, 1e-11,
          [dynamics, n](const ClosedState& state, double* psidd) {
            dynamics->evaluate(Purpose::forward_dynamics, {state.psi, state.psid, state.tau}, {psidd, n});
          }};
}

struct Row {
  double worst = 0, median = 0;  ///< relative error
  double ns = INFINITY;
  std::vector<double> ratios;  ///< to a pass of the first engine just before
};

Row verified(const ClosedEngine& engine, const Known& known) {
  std::vector<double> errors, psidd(16);
  for (std::size_t i = 0; i < known.states.size(); ++i) {
    engine.forward(known.states[i], psidd.data());
    double difference = 0, scale = 1;
    for (std::size_t k = 0; k < known.psidd[i].size(); ++k) {
      const double d = std::abs(psidd[k] - known.psidd[i][k]);
      difference = std::isfinite(d) ? std::max(difference, d) : INFINITY;
      scale = std::max(scale, std::abs(known.psidd[i][k]));
    }
    errors.push_back(difference / scale);
  }
  std::sort(errors.begin(), errors.end());
  return {.worst = errors.back(), .median = errors[errors.size() / 2]};
}

double pass(const ClosedEngine& engine, const Known& known, int count) {
  double psidd[16];
  const auto begin = Clock::now();
  for (int i = 0; i < count; ++i) {
    engine.forward(known.states[static_cast<std::size_t>(i)], psidd);
    asm volatile("" : : "m"(psidd) : "memory");
  }
  return std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / count;
}

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

/// False where an engine misses its tolerance.
bool compare(const char* title, const ScenePtr& scene, ClosedEngines engines, int repeats, double reach = 0) {
  const Known known = known_states(scene, reach);
  engines.insert(engines.begin(),
                 {ours(scene, Evaluation::machine_code), ours(scene, Evaluation::interpreter)});
  std::vector<Row> rows;
  bool held = true;
  for (const ClosedEngine& engine : engines) {
    rows.push_back(verified(engine, known));
    if (rows.back().worst <= engine.tolerance) continue;
    held = false;
    std::fprintf(stderr, "%s: error %.3g is over its tolerance %.3g\n", engine.name.c_str(),
                 rows.back().worst, engine.tolerance);
  }
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t i = 0; i < engines.size(); ++i) {
      // Each after a pass that warms its code and the branch predictors; slow ones take fewer states.
      pass(engines[0], known, kStates);
      const double yardstick = pass(engines[0], known, kStates);
      const int count =
          std::isfinite(rows[i].ns) ? std::clamp(static_cast<int>(100000 / rows[i].ns), 4, kStates) : 4;
      pass(engines[i], known, count);
      const double ns = pass(engines[i], known, count);
      rows[i].ns = std::min(rows[i].ns, ns);
      rows[i].ratios.push_back(ns / yardstick);
    }
  std::printf(
      "| %s | forward dynamics, ns | over machine code | worst error | median |\n|---|---|---|---|---|\n",
      title);
  for (std::size_t i = 0; i < engines.size(); ++i)
    std::printf("| %s | %.1f | %.2f | %.0e | %.0e |\n", engines[i].name.c_str(), rows[i].ns,
                median(rows[i].ratios), rows[i].worst, rows[i].median);
  std::printf("\n");
  return held;
}

int run(int repeats) {
  std::printf("%s\n\n", machine_description().c_str());
  const auto shipped = [](const char* file) {
    return std::make_shared<const Scene>(load_scene(std::filesystem::path(MIXLOOP_SCENES) / file));
  };
  bool held = true;
  {
    const ScenePtr scene = shipped("four_bar.yaml");
    const auto q = known_states(scene);  // closed, to 16 digits
    ClosedEngines peers;
    const auto& first = q.states.front();
    add_mujoco_four_bar(peers, {first.psi[0], first.q[0], first.q[1]});
    add_simbody_four_bar(peers);
    held &= compare("four-bar", scene, std::move(peers), repeats);
  }
  held &= compare("seven bodies", shipped("seven_bodies.yaml"), {}, repeats);
  {
    constexpr double kReach = 0.25;
    const ScenePtr scene = shipped("planar_3rrr.yaml");
    ClosedEngines peers;
    add_mujoco_planar_3rrr(peers, known_states(scene, kReach).states.front());
    add_simbody_planar_3rrr(peers);
    held &= compare("planar 3-RRR", scene, std::move(peers), repeats, kReach);
  }
  {
    constexpr double kReach = 0.3;
    const ScenePtr scene = shipped("delta_robot.yaml");
    ClosedEngines peers;
    add_mujoco_delta_robot(peers, known_states(scene, kReach).states.front());
    add_simbody_delta_robot(peers);
    held &= compare("delta robot", scene, std::move(peers), repeats, kReach);
  }
  {
    const Pantographs ways = pantographs();
    ClosedEngines others{ours(ways.dyad, Evaluation::machine_code, ", linear blocks off: a dyad"),
                         ours(ways.newton, Evaluation::machine_code, ", closed forms off: Newton")};
    held &= compare("the paper's robot, its pantograph by a closure: linear", ways.linear, std::move(others),
                    repeats, 0.25);
  }
  std::printf(
      "Times: the least of all passes. Over machine code: median ratio to a pass of it just before. Errors: "
      "psi'' over\n"
      "%d seeded states, relative, against the procedure in 113 bits.\n",
      kStates);
  return held ? 0 : 1;
}

}  // namespace
}  // namespace mixloop::bench

int main(int argc, char** argv) {
  return mixloop::bench::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 1000);
}
