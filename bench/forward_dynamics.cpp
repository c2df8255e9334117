// SPDX-License-Identifier: MIT
// The paper's robot in every engine at hand: forward dynamics and mass matrix, verified against the closed
// form in 113-bit floats first, then timed interleaved; the least of many repeats counts.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>

#include "bench/engine.hpp"
#include "bench/machine.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kStates = 256;

std::vector<State> seeded_states() {
  std::mt19937_64 random(20260415);
  std::uniform_real_distribution<double> angle(-30, 30), rate(-40, 40), torque(-5, 5);
  std::vector<State> states(kStates);
  for (State& state : states)
    for (int k = 0; k < 3; ++k) {
      state.psi[k] = angle(random);
      state.psid[k] = rate(random);
      state.tau[k] = torque(random);
    }
  return states;
}

std::vector<Triple> oracle_accelerations(const std::vector<State>& states) {
  using oracle::Wide;
  using Vector = oracle::MixedLoopRobot<Wide>::Vector3;
  const oracle::MixedLoopRobot<Wide> robot(oracle::paper_numbers<Wide>());
  std::vector<Triple> expected;
  for (const State& state : states) {
    const auto wide = [](const Triple& x) { return Vector(Wide(x[0]), Wide(x[1]), Wide(x[2])); };
    const Vector psidd = robot.forward_dynamics(wide(state.psi), wide(state.psid), wide(state.tau));
    expected.push_back({static_cast<double>(psidd[0]), static_cast<double>(psidd[1]), static_cast<double>(psidd[2])});
  }
  return expected;
}

std::vector<Symmetric> oracle_masses(const std::vector<State>& states) {
  using oracle::Wide;
  const oracle::MixedLoopRobot<Wide> robot(oracle::paper_numbers<Wide>());
  std::vector<Symmetric> expected;
  for (const State& state : states) {
    const auto M = robot.mass_matrix({Wide(state.psi[0]), Wide(state.psi[1]), Wide(state.psi[2])});
    Symmetric upper;
    int k = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) upper[k++] = static_cast<double>(M(i, j));
    expected.push_back(upper);
  }
  return expected;
}

/// Largest and median difference, relative to the largest entry of each expected row.
struct Error {
  double worst = 0, median = 0;
};

template <class Row>
Error relative_error(const std::vector<Row>& actual, const std::vector<Row>& expected) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    double difference = 0, scale = 0;
    for (std::size_t k = 0; k < expected[i].size(); ++k) {
      const double d = std::abs(actual[i][k] - expected[i][k]);
      difference = std::isfinite(d) ? std::max(difference, d) : INFINITY;
      scale = std::max(scale, std::abs(expected[i][k]));
    }
    errors.push_back(difference / scale);
  }
  std::sort(errors.begin(), errors.end());
  return {errors.back(), errors[errors.size() / 2]};
}

struct Row {
  Error forward_error, mass_error;
  double forward = INFINITY, chained = INFINITY, mass = INFINITY;  // ns
};

void keep(const auto& value) { asm volatile("" : : "m"(value) : "memory"); }

double ns_each(Clock::time_point begin, Clock::time_point end, int evaluations) {
  return std::chrono::duration<double, std::nano>(end - begin).count() / evaluations;
}

/// One pass over `count` states: independent ones, then each started from the one before.
void time_once(const Engine& engine, const std::vector<State>& states, int count, Row& row) {
  Triple psidd{};
  Symmetric M{};
  if (engine.forward_all) {
    std::vector<Triple> nothing;
    const auto begin = Clock::now();
    engine.forward_all(states, nothing);
    row.forward = std::min(row.forward, ns_each(begin, Clock::now(), kStates));
    return;
  }
  auto begin = Clock::now();
  for (int i = 0; i < count; ++i) {
    engine.forward(states[i], psidd);
    keep(psidd);
  }
  row.forward = std::min(row.forward, ns_each(begin, Clock::now(), count));
  State next = states[0];
  begin = Clock::now();
  for (int i = 0; i < count; ++i) {
    engine.forward(next, psidd);
    next = states[i];
    for (int k = 0; k < 3; ++k) next.psi[k] += 1e-12 * psidd[k];
  }
  keep(next);
  row.chained = std::min(row.chained, ns_each(begin, Clock::now(), count));
  if (!engine.mass) return;
  begin = Clock::now();
  for (int i = 0; i < count; ++i) {
    engine.mass(states[i], M);
    keep(M);
  }
  row.mass = std::min(row.mass, ns_each(begin, Clock::now(), count));
}

Row verified(const Engine& engine, const std::vector<State>& states, const std::vector<Triple>& psidd,
             const std::vector<Symmetric>& masses) {
  Row row;
  std::vector<Triple> actual(states.size());
  if (engine.forward_all)
    engine.forward_all(states, actual);
  else
    for (std::size_t i = 0; i < states.size(); ++i) engine.forward(states[i], actual[i]);
  row.forward_error = relative_error(actual, psidd);
  if (engine.mass) {
    std::vector<Symmetric> M(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) engine.mass(states[i], M[i]);
    row.mass_error = relative_error(M, masses);
  }
  return row;
}

std::string cell(double value, const char* format) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void print_table(const Engines& engines, const std::vector<Row>& rows, double yardstick) {
  std::printf("%s\n\n", machine_description().c_str());
  std::printf("| engine | forward dynamics, ns | over hand-tuned | chained, ns | M only, ns | worst error | median |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    std::printf("| %s | %s | %s | %s | %s | %s | %s |\n", engines[i].name.c_str(),
                cell(row.forward, "%.1f").c_str(), cell(row.forward / yardstick, "%.2f").c_str(),
                cell(row.chained, "%.1f").c_str(), cell(row.mass, "%.1f").c_str(),
                cell(row.forward_error.worst, "%.0e").c_str(), cell(row.forward_error.median, "%.0e").c_str());
  }
  std::printf(
      "\nWorst and median: relative error of psi'' over %d seeded states against the closed form in 113 bits.\n"
      "Independent states overlap in the processor; chained ones wait for each other, as an integrator's do.\n"
      "Over hand-tuned: over the row `hand-tuned, 3 inlined sincos`.\n",
      kStates);
}

int run(int repeats) {
  const auto states = seeded_states();
  const auto psidd = oracle_accelerations(states);
  const auto masses = oracle_masses(states);
  Engines engines;
  add_hand_tuned(engines);
  add_hand_tuned_contracted(engines);
  add_mixloop(engines);
  add_textbook(engines);
  add_mujoco(engines);
  add_simbody(engines);

  std::vector<Row> rows;
  bool held = true;
  for (const Engine& engine : engines) {
    rows.push_back(verified(engine, states, psidd, masses));
    const Row& row = rows.back();
    if (row.forward_error.worst <= engine.tolerance && row.mass_error.worst <= engine.tolerance) continue;
    held = false;
    std::fprintf(stderr, "%s: error %.3g (M %.3g) is over its tolerance %.3g\n", engine.name.c_str(),
                 row.forward_error.worst, row.mass_error.worst, engine.tolerance);
  }
  if (!held) return 1;

  // Slow engines take fewer states a pass, so that all are interleaved at about the same pace.
  std::vector<int> counts;
  for (std::size_t i = 0; i < engines.size(); ++i) {
    time_once(engines[i], states, 16, rows[i]);
    const double fits = 20000.0 / std::max(1.0, rows[i].forward);
    counts.push_back(std::clamp(static_cast<int>(fits), 8, kStates));
  }
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t i = 0; i < engines.size(); ++i) time_once(engines[i], states, counts[i], rows[i]);

  double yardstick = INFINITY;
  for (std::size_t i = 0; i < engines.size(); ++i)
    if (engines[i].name == "hand-tuned, 3 inlined sincos") yardstick = rows[i].forward;
  print_table(engines, rows, yardstick);
  return 0;
}

}  // namespace
}  // namespace mixloop::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 2000;
  return mixloop::bench::run(repeats);
}
