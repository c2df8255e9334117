// SPDX-License-Identifier: MIT
// What a process that simulates takes: the whole tick of the closed loop (the plant's RK4, controller,
// planner), and the time until its programs are there, from nothing and from the cache. Markdown.
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/machine.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/program/trace.hpp"
#include "loop/simulate.hpp"

namespace mixloop::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds(auto&& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// us a tick, the least of `runs` runs of the paper's 1 s at 1 kHz.
double tick_time(Evaluation how, int runs) {
  Experiment experiment =
      load_experiment(fs::path(MIXLOOP_EXPERIMENTS "/paper.yaml"), std::vector<Override>{});
  experiment.evaluation = how;
  const Plan plan = make_plan(experiment);
  double least = 1e9;
  for (int i = 0; i < runs; ++i) {
    RecordedPlant run(experiment, plan);
    Clock::time_point first, last;
    std::int64_t ticks = 0;
    simulate(run, [&](std::int64_t k) {  // past the set-up: from tick to tick
      if (k == 0) first = Clock::now();
      if (k % 100 == 0) last = Clock::now(), ticks = k;
      return true;
    });
    const double whole = std::chrono::duration<double>(last - first).count();
    least = std::min(least, 1e6 * whole / static_cast<double>(ticks));
  }
  return least;
}

void print_ticks() {
  std::printf("| whole tick of the closed loop, in process, by | us | over machine code |\n|---|---|---|\n");
  const double compiled = tick_time(Evaluation::machine_code, 40);
  for (const auto& [how, runs] :
       {std::pair{Evaluation::machine_code, 40}, {Evaluation::interpreter, 40}, {Evaluation::reference, 5}}) {
    const double us = how == Evaluation::machine_code ? compiled : tick_time(how, runs);
    std::printf("| %s | %.2f | %.1f |\n", std::string(name_of(how)).c_str(), us, us / compiled);
  }
}

/// ms until equations of these purposes stands.
double construction(const std::shared_ptr<const Scene>& scene, std::initializer_list<Purpose> purposes) {
  return 1e3 * seconds([&] { equations_of(scene, Evaluation::machine_code, purposes); });
}

/// The same in a process of its own, whose cache is `directory`: median of several.
double in_fresh_process(const std::string& program, int times) {
  std::vector<double> found;
  for (int i = 0; i < times; ++i) {
    FILE* pipe = ::popen((program + " construct").c_str(), "r");
    double ms = 0;
    if (pipe == nullptr || std::fscanf(pipe, "%lf", &ms) != 1) std::exit(3);
    ::pclose(pipe);
    found.push_back(ms);
  }
  std::sort(found.begin(), found.end());
  return found[found.size() / 2];
}

void print_compile_times(const std::shared_ptr<const Scene>& scene, const std::string& program) {
  std::string pattern = (fs::temp_directory_path() / "mixloop-bench-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) std::exit(3);
  ::setenv("MIXLOOP_CACHE", (pattern + "/cache").c_str(), 1);
  const double tracing = 1e3 * seconds([&] { trace(scene, Purpose::forward_dynamics); });
  const double nothing = in_fresh_process(program, 1);
  const double one = construction(scene, {Purpose::forward_dynamics});
  const double kept = in_fresh_process(program, 15);
  fs::remove_all(pattern);
  std::printf(
      "\n| until the paper's programs stand | ms |\n|---|---|\n"
      "| tracing forward dynamics | %.0f |\n"
      "| forward dynamics, M a and end effector (plant, controller, planner), from nothing | %.0f |\n"
      "| the same from the cache, in a fresh process | %.1f |\n"
      "| one more program from the cache | %.2f |\n",
      tracing, nothing, kept, one);
}

}  // namespace
}  // namespace mixloop::bench

int main(int argc, char** argv) {
  using namespace mixloop;
  const auto scene = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  if (argc > 1 && std::string(argv[1]) == "construct") {
    std::printf("%f\n", bench::construction(
                            scene, {Purpose::forward_dynamics, Purpose::mass_times, Purpose::end_effector}));
    return 0;
  }
  std::printf("%s\n\n", bench::machine_description().c_str());
  bench::print_ticks();
  bench::print_compile_times(scene, argv[0]);
}
