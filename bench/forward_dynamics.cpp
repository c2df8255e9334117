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

#include "bench/engine.hpp"
#include "bench/machine.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kStates = 256;
constexpr const char* kYardstick = "hand-tuned, 3 inlined sincos";

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
    expected.push_back(
        {static_cast<double>(psidd[0]), static_cast<double>(psidd[1]), static_cast<double>(psidd[2])});
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
  // ns an evaluation, the least of all passes
  double forward = INFINITY, chained = INFINITY, mass = INFINITY, mass_times = INFINITY, both = INFINITY;
  std::vector<double> ratios;  // of forward to the yardstick's pass just before it
};

void keep(const auto& value) { asm volatile("" : : "m"(value) : "memory"); }

/// Lowers `least` to the time of one of `count` evaluations; returns that time.
double time_pass(double& least, int count, auto&& evaluations) {
  const auto begin = Clock::now();
  evaluations();
  const double ns = std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / count;
  least = std::min(least, ns);
  return ns;
}

/// Forward dynamics of independent states.
double time_forward(const Engine& engine, const std::vector<State>& states, int count, double& least) {
  if (engine.forward_all) {
    std::vector<Triple> nothing;
    return time_pass(least, kStates, [&] { engine.forward_all(states, nothing); });
  }
  Triple psidd{};
  return time_pass(least, count, [&] {
    for (int i = 0; i < count; ++i) engine.forward(states[static_cast<std::size_t>(i)], psidd), keep(psidd);
  });
}

/// The rest over `count` states: each evaluation started from the one before, then M and M a.
void time_others(const Engine& engine, const std::vector<State>& states, int count, Row& row) {
  if (engine.forward_all) return;
  Triple psidd{}, force{};
  MassMatrix M{};
  const auto each = [&](double& least, auto&& evaluation) {
    time_pass(least, count, [&] {
      for (int i = 0; i < count; ++i) evaluation(states[static_cast<std::size_t>(i)]);
    });
  };
  State next = states[0];
  each(row.chained, [&](const State& state) {
    engine.forward(next, psidd);
    next = state;
    for (std::size_t k = 0; k < 3; ++k) next.psi[k] += 1e-12 * psidd[k];
  });
  keep(next);
  if (engine.mass) each(row.mass, [&](const State& state) { engine.mass(state, M), keep(M); });
  if (engine.mass_times)
    each(row.mass_times, [&](const State& state) { engine.mass_times(state, force), keep(force); });
  if (engine.forward_and_mass_times)
    each(row.both, [&](const State& state) {
      engine.forward_and_mass_times(state, psidd, force), keep(psidd), keep(force);
    });
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
    for (std::size_t i = 0; i < states.size(); ++i) {
      MassMatrix x{};
      engine.mass(states[i], x);
      M[i] = engine.whole_matrix ? Symmetric{x[0], x[3], x[6], x[4], x[7], x[8]}
                                 : Symmetric{x[0], x[1], x[2], x[3], x[4], x[5]};
    }
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

std::string ratio_cell(std::vector<double> ratios) {
  if (ratios.empty()) return "";
  std::sort(ratios.begin(), ratios.end());
  return cell(ratios[ratios.size() / 2], "%.2f");
}

double median_ratio(const Engines& engines, const std::vector<Row>& rows, const std::string& name) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (engines[i].name != name || rows[i].ratios.empty()) continue;
    std::vector<double> ratios = rows[i].ratios;
    std::sort(ratios.begin(), ratios.end());
    return ratios[ratios.size() / 2];
  }
  return NAN;  // a peer that isn't there
}

/// A time of one engine over another's: of forward dynamics a quotient of medians over the same yardstick, of
/// the rest of the least times.
struct Asked {
  const char* of;
  double Row::*time;
  std::string slow, fast;
  const char* bound;
};

double measured(const Asked& asked, const Engines& engines, const std::vector<Row>& rows) {
  if (asked.time == &Row::forward)
    return median_ratio(engines, rows, asked.slow) / median_ratio(engines, rows, asked.fast);
  const auto time_of = [&](const std::string& name) {
    for (std::size_t i = 0; i < engines.size(); ++i)
      if (engines[i].name == name) return rows[i].*asked.time;
    return static_cast<double>(NAN);
  };
  return time_of(asked.slow) / time_of(asked.fast);
}

/// What the project is asked for.
void print_ratios(const Engines& engines, const std::vector<Row>& rows) {
  const std::string code = "mixloop, machine code, ", inlined = code + "inlined sincos",
                    known_late = inlined + ", payload a parameter", fused = "hand-tuned (fused), ",
                    vectors = fused + "vectors inside, one 4-lane sincos";
  std::string lanes;
  for (const Engine& engine : engines)
    if (engine.name.rfind(code, 0) == 0 && engine.name.ends_with("lanes")) lanes = engine.name;
  const std::vector<Asked> all{
      {"forward dynamics", &Row::forward, known_late, vectors, "at most 1.05"},
      {"chained", &Row::chained, known_late, vectors, "at most 1.00"},
      {"M", &Row::mass, known_late, vectors, "at most 1.10"},
      {"M a", &Row::mass_times, known_late, fused + "3 inlined sincos, payload a parameter", "at most 1.00"},
      {"forward dynamics", &Row::forward, code + "C library sincos", fused + "3 C library sincos",
       "at most 1.05"},
      {"forward dynamics", &Row::forward, lanes, fused + lanes.substr(lanes.size() - 7), "at most 1.05"},
      {"forward dynamics", &Row::forward, inlined, lanes, "at least 6.8"},
      {"forward dynamics", &Row::forward, "MuJoCo 2.2.2, couplings as its equality constraints", inlined,
       "at least 115"},
      {"forward dynamics", &Row::forward, "Simbody 3.7, three coordinate couplers", inlined, ""},
      {"forward dynamics", &Row::forward, "textbook route in Eigen (composite body, Newton-Euler, C)",
       inlined, "at least 18"},
      {"forward dynamics", &Row::forward, "mixloop, interpreter", inlined, "at most 4"},
  };
  std::printf("\n| of | time of | over that of | asked | measured |\n|---|---|---|---|---|\n");
  for (const Asked& asked : all) {
    const double ratio = measured(asked, engines, rows);
    if (std::isfinite(ratio))
      std::printf("| %s | %s | %s | %s | %.2f |\n", asked.of, asked.slow.c_str(), asked.fast.c_str(),
                  asked.bound, ratio);
  }
}

void print_table(const Engines& engines, const std::vector<Row>& rows) {
  std::printf("%s\n\n", machine_description().c_str());
  std::printf(
      "| engine | forward dynamics, ns | over hand-tuned | chained, ns | M, ns | M a, ns | both, ns "
      "| worst error | median |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    std::string line =
        "| " + engines[i].name + " | " + cell(row.forward, "%.1f") + " | " + ratio_cell(row.ratios);
    for (const double ns : {row.chained, row.mass, row.mass_times, row.both})
      line += " | " + cell(ns, "%.1f");
    for (const double error : {row.forward_error.worst, row.forward_error.median})
      line += " | " + cell(error, "%.0e");
    std::printf("%s |\n", line.c_str());
  }
  std::printf(
      "\nTimes: the least of all passes. Over hand-tuned: median ratio to a pass of `%s` just before.\n"
      "Independent states overlap in the processor; chained ones wait for each other, as an integrator's "
      "do.\n"
      "Both: psi'' and M a, the feed-forward, in one evaluation. Errors: psi'' over %d seeded states, "
      "relative,\n"
      "against the closed form in 113 bits.\n",
      kYardstick, kStates);
}

Engines all_engines() {
  Engines engines;
  add_hand_tuned(engines);
  add_hand_tuned_contracted(engines);
  add_mixloop(engines);
  add_textbook(engines);
  add_mujoco(engines);
  add_simbody(engines);
  return engines;
}

/// False, with the offender on stderr, unless every engine keeps its tolerance.
bool verify(const Engines& engines, const std::vector<State>& states, std::vector<Row>& rows) {
  const auto psidd = oracle_accelerations(states);
  const auto masses = oracle_masses(states);
  bool held = true;
  for (const Engine& engine : engines) {
    rows.push_back(verified(engine, states, psidd, masses));
    const Row& row = rows.back();
    if (row.forward_error.worst <= engine.tolerance && row.mass_error.worst <= engine.tolerance) continue;
    held = false;
    std::fprintf(stderr, "%s: error %.3g (M %.3g) is over its tolerance %.3g\n", engine.name.c_str(),
                 row.forward_error.worst, row.mass_error.worst, engine.tolerance);
  }
  return held;
}

int run(int repeats) {
  const auto states = seeded_states();
  const Engines engines = all_engines();
  std::vector<Row> rows;
  if (!verify(engines, states, rows)) return 1;
  const Engine& yardstick = *std::find_if(engines.begin(), engines.end(),
                                          [](const Engine& engine) { return engine.name == kYardstick; });

  // Slow engines take fewer states a pass, so that all are interleaved at about the same pace.
  std::vector<int> counts;
  double unused = INFINITY;
  for (const Engine& engine : engines) {
    double ns = INFINITY;
    time_forward(engine, states, 16, ns);
    counts.push_back(std::clamp(static_cast<int>(20000.0 / std::max(1.0, ns)), 8, kStates));
  }
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t i = 0; i < engines.size(); ++i) {
      // Each after a pass that warms its code and the branch predictors.
      time_forward(yardstick, states, kStates, unused);
      const double reference = time_forward(yardstick, states, kStates, unused);
      time_forward(engines[i], states, counts[i], rows[i].forward);
      rows[i].ratios.push_back(time_forward(engines[i], states, counts[i], rows[i].forward) / reference);
      time_others(engines[i], states, counts[i], rows[i]);
    }
  print_table(engines, rows);
  print_ratios(engines, rows);
  return 0;
}

}  // namespace
}  // namespace mixloop::bench

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1000;
  return mixloop::bench::run(repeats);
}
