// SPDX-License-Identifier: MIT
// How forward dynamics grows with a mechanism: serial chains of revolute joints, chains of
// parallelograms, and of four-bar loops by their closures.
// One line a size, tab-separated (bench/growth makes the table and the figure of it).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/document.hpp"
#include "tests/oracles/chains.hpp"

namespace mixloop::bench {
namespace {

using Clock = std::chrono::steady_clock;
using ScenePtr = std::shared_ptr<const Scene>;

double seconds(auto&& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

struct State {
  std::vector<double> psi, psid, tau;
};

/// Where chains close, at home.
State seeded_state(const Scene& scene) {
  const int n = scene.n();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  State state;
  for (int i = 0; i < n; ++i) {
    state.psi.push_back(unit(random)), state.psid.push_back(unit(random)), state.tau.push_back(unit(random));
  }
  if (scene.is_closed()) state.psi = scene.home;
  return state;
}

/// ns an evaluation, the least of many passes of 20 us or more.
double evaluation_time(const Routine& routine, const ScenePtr& scene) {
  Evaluator evaluator(routine);
  evaluator.set_up({});
  const State state = seeded_state(*scene);
  std::vector<double> out(state.psi.size());
  const auto pass = [&](int count) {
    return 1e9 / count * seconds([&] {
             for (int i = 0; i < count; ++i) {
               evaluator.evaluate({state.psi, state.psid, state.tau}, out);
               asm volatile("" : : "r"(out.data()) : "memory");
             }
           });
  };
  const int count = std::max(1, static_cast<int>(20000.0 / pass(1)));
  double least = pass(count);
  for (int i = 0; i < 40; ++i) least = std::min(least, pass(count));
  return least;
}

std::string flops(const ScenePtr& scene, Tracing tracing) {
  const Program program = trace(scene, Purpose::forward_dynamics, tracing);
  return program.outputs.empty() ? "-" : std::to_string(program.run_operations().flops());
}

void line(const char* family, int n, const ScenePtr& scene) {
  TracedProgram traced;
  const double tracing = seconds([&] { traced = trace(scene, Purpose::forward_dynamics); });
  const OperationCount count = traced.program.run_operations();
  std::string complaint;
  std::unique_ptr<MachineCode> code;
  const std::string key = "growth " + std::to_string(Clock::now().time_since_epoch().count());  // built anew
  const double compiling = seconds([&] {
    code = MachineCode::load(
        key, [&] { return traced.program; }, complaint);
  });
  if (!code && !complaint.empty()) std::fprintf(stderr, "%s\n", complaint.c_str()), std::exit(1);
  const auto text = [](double value, const char* format) {
    char written[32];
    std::snprintf(written, sizeof written, format, value);
    return std::string(written);
  };
  // Too long to compile: interpreted.
  const std::string compile_time = code ? text(compiling, "%.2f") : "-";
  const std::string compiled = code ? text(evaluation_time(*code, scene), "%.0f") : "-";
  const double interpreted = evaluation_time(Interpreter(traced.program), scene);
  const double procedure = evaluation_time(*reference_routine(scene, Purpose::forward_dynamics), scene);
  std::printf("%s\t%d\t%d\t%s\t%zu\t%zu\t%s\t%s\t%.1f\t%s\t%s\t%.0f\t%.0f\n", family, n, scene->m(),
              std::string(name_of(traced.tracing)).c_str(), count.flops(), count.sincos,
              flops(scene, Tracing::recursive).c_str(), flops(scene, Tracing::articulated).c_str(),
              1e3 * tracing, compile_time.c_str(), compiled.c_str(), interpreted, procedure);
  std::fflush(stdout);
}

void family(const char* name, std::initializer_list<int> sizes, const std::function<std::string(int)>& text) {
  for (int n : sizes) line(name, n, std::make_shared<const Scene>(load_scene(parse_document(text(n), name))));
}

}  // namespace
}  // namespace mixloop::bench

int main() {
  using namespace mixloop;
  std::printf(
      "family\tn\tm\ttracing\tflops\tsincos\trecursive\tarticulated\ttrace_ms\tcompile_s\tmachine_code_ns\t"
      "interpreter_ns\treference_ns\n");
  bench::family("serial", {2, 3, 4, 6, 8, 10, 12, 16, 24, 32, 48, 64}, oracle::serial_chain);
  bench::family("parallelograms", {1, 2, 3, 4, 6, 8, 12, 16}, oracle::parallelogram_chain);
  bench::family("four-bars", {1, 2, 3, 4, 6, 8, 12, 16, 24, 32}, oracle::four_bar_chain_of);
}
