// SPDX-License-Identifier: MIT
// Error against CPU time for every integrator, step and way of evaluation, and for the peers: one table of
// points.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>

#include "bench/machine.hpp"
#include "bench/work_precision.hpp"

namespace mixloop::bench {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The project's own plant and controller over a problem.
class Runner {
 public:
  Runner(const Case& problem, PlantSettings settings, Evaluation how)
      : case_(problem), n_(problem.psi0.size()) {
    Experiment experiment = problem.experiment;
    experiment.evaluation = how;
    settings.continuous = problem.drive == Case::Drive::continuous;
    settings.initial_psi = {};
    experiment.plant = settings;
    if (problem.drive != Case::Drive::table) {
      plan_ = std::make_unique<Plan>(make_plan(experiment));
      controller_ = std::make_unique<Controller>(make_controller(experiment));
      plant_ = std::make_unique<Plant>(make_plant(experiment, *plan_));
    } else {
      plant_ = std::make_unique<Plant>(
          Equations::Workspace(plant_equations(experiment.scene, how, settings), experiment.plant_parameters),
          settings, experiment.rate_hz, problem.psi0, problem.psid0);
    }
  }

  Samples run() {
    Samples samples;
    samples.reserve(static_cast<std::size_t>(case_.ticks / case_.sample_every));
    std::vector<double> tau(n_);
    const auto control = [&](int row, double t, std::span<const double> psi, std::span<const double> psid,
                             std::span<double> out) {
      controller_->torque({psi, psid, t}, plan_->at_stage(plant_->tick(), row), out);
    };
    for (int k = 0; k < case_.ticks; ++k) {
      if (case_.drive == Case::Drive::continuous) {
        plant_->advance_continuously(control);
      } else {
        if (case_.drive == Case::Drive::table)
          case_.torque(k, tau);
        else
          controller_->torque({plant_->psi(), plant_->psid(), plant_->time()}, plan_->at(k), tau);
        plant_->command(tau);
        plant_->advance();
      }
      if ((k + 1) % case_.sample_every != 0) continue;
      samples.emplace_back(plant_->psi().begin(), plant_->psi().end());
      samples.back().insert(samples.back().end(), plant_->psid().begin(), plant_->psid().end());
    }
    return samples;
  }

 private:
  const Case& case_;
  std::size_t n_;
  std::unique_ptr<Plan> plan_;
  std::unique_ptr<Controller> controller_;
  std::unique_ptr<Plant> plant_;
};

/// Takes points: each run is prepared outside of the clock, and repeated.
class Bench {
 public:
  Bench(int repeats, const char* file) : repeats_(repeats), out_(file) {
    out_ << "# problem\tcurve\tsetting\terror\tcpu_s\n# " << machine_description() << "\n";
  }

  void look(const Case& problem) {
    std::printf("%s: %s\n", problem.name.c_str(), problem.title.c_str());
    converged_ = converged_samples(problem);
    for (const MethodFacts& method : all_methods()) own_curve(problem, method, Evaluation::machine_code);
    if (problem.closed) {
      Case told_by_closures = problem;
      told_by_closures.experiment.scene = problem.closed;
      for (const MethodFacts& method : all_methods())
        own_curve(told_by_closures, method, Evaluation::machine_code, "by closures, ");
    }
    for (const Method method : {Method::rk4, Method::dop853})
      for (const Evaluation how : {Evaluation::interpreter, Evaluation::reference})
        own_curve(problem, facts(method), how);
    const Keep keep = [&](const std::string& curve, const std::string& setting,
                          const std::function<Samples()>& run) {
      take(problem, curve, setting, [&] { return run; });
    };
    sundials_points(problem, keep);
    if (problem.papers_robot && problem.drive != Case::Drive::continuous) peer_points(problem, keep);
  }

 private:
  void own_curve(const Case& problem, const MethodFacts& method, Evaluation how, const char* told = "") {
    if (method.jacobian && problem.drive == Case::Drive::continuous) return;
    const std::string curve = told + std::string(method.name) +
                              (how == Evaluation::machine_code ? "" : ", " + std::string(name_of(how)));
    // Of machine code four to an octave: an order of 8 gains two digits in an octave.
    const bool slow = how == Evaluation::reference, fine = how == Evaluation::machine_code;
    const auto next = [&](int substeps) {
      const auto octave = static_cast<int>(std::bit_floor(static_cast<unsigned>(substeps)));
      return fine ? std::max(1, octave / 4) : octave;
    };
    for (int substeps = 1; substeps <= (slow ? 4 : method.order < 3 ? 128 : 32); substeps += next(substeps))
      own_point(problem, curve, {.integrator = method.method, .substeps = substeps}, how);
    if (!method.error_control || problem.drive == Case::Drive::continuous || how != Evaluation::machine_code)
      return;
    for (const double error : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14})
      own_point(problem, curve + ", error control", {.integrator = method.method, .local_error = error}, how);
  }

  void own_point(const Case& problem, const std::string& curve, const PlantSettings& settings,
                 Evaluation how) {
    char setting[40];
    if (settings.local_error > 0)
      std::snprintf(setting, sizeof setting, "local_error %.0e", settings.local_error);
    else
      std::snprintf(setting, sizeof setting, "substeps %d", settings.substeps);
    take(problem, curve, setting, [&] {
      auto runner = std::make_shared<Runner>(problem, settings, how);
      return [runner] { return runner->run(); };
    });
  }

  template <class Prepare>
  void take(const Case& problem, const std::string& curve, const std::string& setting,
            const Prepare& prepare) {
    Point point{problem.name, curve, setting, 0, HUGE_VAL};
    for (int repeat = 0; repeat < repeats_; ++repeat) {
      const std::function<Samples()> run = prepare();
      const double begin = cpu_seconds();
      const Samples samples = run();
      const double seconds = cpu_seconds() - begin;
      point.cpu = std::min(point.cpu, seconds);
      point.error = error_of(samples, converged_);
      if (!std::isfinite(point.error) || (repeat > 1 && seconds > 0.03)) break;
    }
    if (!std::isfinite(point.error)) return;
    out_ << problem.name << '\t' << curve << '\t' << setting << '\t' << point.error << '\t' << point.cpu
         << std::endl;
  }

  int repeats_;
  std::ofstream out_;
  Samples converged_;
};

int run(int argc, char** argv) {
  const auto cases = all_cases();
  const auto wanted = [&](const Case& problem, int from) {
    return argc <= from ||
           std::any_of(argv + from, argv + argc, [&](const char* name) { return problem.name == name; });
  };
  if (argc > 1 && std::strcmp(argv[1], "--converge") == 0) {
    for (const Case& problem : cases)
      if (wanted(problem, 2)) converge(problem);
    return 0;
  }
  if (argc < 2) {
    std::fprintf(
        stderr,
        "mixloop-bench-work-precision FILE [problem...]       writes the points, tab-separated\n"
        "mixloop-bench-work-precision --converge [problem...]  works the converged motions out again\n");
    return 2;
  }
  Bench bench(7, argv[1]);
  for (const Case& problem : cases)
    if (wanted(problem, 2)) bench.look(problem);
  return 0;
}

}  // namespace
}  // namespace mixloop::bench

int main(int argc, char** argv) { return mixloop::bench::run(argc, argv); }
