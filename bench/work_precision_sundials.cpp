// SPDX-License-Identifier: MIT
// SUNDIALS on our forward dynamics: CVODE's Adams method with fixed-point iteration, its BDF with Newton and
// our exact Jacobian, and ARKODE's explicit methods of orders 5 and 8.
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstdio>
#include <stdexcept>

#include "bench/papers_path.hpp"
#include "bench/work_precision.hpp"

namespace mixloop::bench {
namespace {

enum class Kind { adams, bdf, erk5, erk8 };

/// The right-hand side and the torque in effect.
struct Plantlike {
  const Case* problem;
  int n;
  Equations::Workspace dynamics;
  Controller controller;
  std::vector<double> tau, linear;

  explicit Plantlike(const Case& c)
      : problem(&c),
        n(c.n()),
        dynamics(equations_of(c.experiment.scene, Evaluation::machine_code,
                              {Purpose::forward_dynamics, Purpose::linearisation}),
                 c.experiment.plant_parameters),
        controller(c.drive == Case::Drive::table ? Controller(no_dynamics(c), {})
                                                 : make_controller(c.experiment)),
        tau(static_cast<std::size_t>(n)),
        linear(static_cast<std::size_t>(3 * n * n)) {}

  static Equations::Workspace no_dynamics(const Case& c) {
    return {equations_of(c.experiment.scene, Evaluation::reference, {}), c.experiment.plant_parameters};
  }
  std::span<const double> part(const double* x, int from) const {
    return {x + from, static_cast<std::size_t>(n)};
  }

  void control(double t, const double* x) {
    const auto at = papers_reference<double>(t);
    Eigen::Matrix<double, 18, 1> row;
    row << at.psi, at.psid, at.psidd, Vector::Zero(9);
    controller.torque({part(x, 0), part(x, n), t}, reference_in({row.data(), 18}, 3), tau);
  }
};

int rate(double t, N_Vector y, N_Vector ydot, void* user) {
  auto& plant = *static_cast<Plantlike*>(user);
  const double* x = N_VGetArrayPointer(y);
  double* dx = N_VGetArrayPointer(ydot);
  if (plant.problem->drive == Case::Drive::continuous) plant.control(t, x);
  std::copy(x + plant.n, x + 2 * plant.n, dx);
  plant.dynamics.evaluate(Purpose::forward_dynamics, {plant.part(x, 0), plant.part(x, plant.n), plant.tau, t},
                          {dx + plant.n, static_cast<std::size_t>(plant.n)});
  return 0;
}

int jacobian(double t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector, N_Vector) {
  auto& plant = *static_cast<Plantlike*>(user);
  const double* x = N_VGetArrayPointer(y);
  const int n = plant.n;
  plant.dynamics.evaluate(Purpose::linearisation, {plant.part(x, 0), plant.part(x, n), plant.tau, t},
                          plant.linear);
  SUNMatZero(J);
  for (int j = 0; j < n; ++j) {
    SM_ELEMENT_D(J, j, n + j) = 1;
    for (int i = 0; i < n; ++i) {
      SM_ELEMENT_D(J, n + i, j) = plant.linear[static_cast<std::size_t>(j * n + i)];
      SM_ELEMENT_D(J, n + i, n + j) = plant.linear[static_cast<std::size_t>(n * n + j * n + i)];
    }
  }
  return 0;
}

void check(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string("SUNDIALS: ") + what);
}

/// One solver, kept from tick to tick and started again at each, its tolerances relative and absolute alike.
class Solver {
 public:
  Solver(Plantlike& plant, Kind kind, double tolerance) : plant_(plant), kind_(kind) {
    SUNContext_Create(nullptr, &context_);
    const int size = 2 * plant.n;
    y_ = N_VNew_Serial(size, context_);
    N_VConst(0, y_);
    if (kind == Kind::adams || kind == Kind::bdf) {
      memory_ = CVodeCreate(kind == Kind::adams ? CV_ADAMS : CV_BDF, context_);
      check(CVodeInit(memory_, rate, 0, y_), "CVodeInit");
      CVodeSStolerances(memory_, tolerance, tolerance);
      CVodeSetUserData(memory_, &plant);
      CVodeSetMaxNumSteps(memory_, 1000000);
      CVodeSetErrFile(memory_, nullptr);
      if (kind == Kind::adams) {
        iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
        check(CVodeSetNonlinearSolver(memory_, iteration_), "fixed point");
      } else {
        matrix_ = SUNDenseMatrix(size, size, context_);
        linear_ = SUNLinSol_Dense(y_, matrix_, context_);
        check(CVodeSetLinearSolver(memory_, linear_, matrix_), "dense");
        check(CVodeSetJacFn(memory_, jacobian), "Jacobian");
      }
    } else {
      memory_ = ERKStepCreate(rate, 0, y_, context_);
      ERKStepSStolerances(memory_, tolerance, tolerance);
      ERKStepSetUserData(memory_, &plant);
      ERKStepSetMaxNumSteps(memory_, 1000000);
      ERKStepSetErrFile(memory_, nullptr);
      ERKStepSetOrder(memory_, kind == Kind::erk5 ? 5 : 8);
    }
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  ~Solver() {
    if (kind_ == Kind::adams || kind_ == Kind::bdf)
      CVodeFree(&memory_);
    else
      ERKStepFree(&memory_);
    if (iteration_) SUNNonlinSolFree(iteration_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  double* state() { return N_VGetArrayPointer(y_); }

  void start(double t) {
    if (kind_ == Kind::adams || kind_ == Kind::bdf)
      CVodeReInit(memory_, t, y_);
    else
      ERKStepReInit(memory_, rate, t, y_);
  }
  bool advance(double end) {
    double t = 0;
    if (kind_ == Kind::adams || kind_ == Kind::bdf) {
      CVodeSetStopTime(memory_, end);
      return CVode(memory_, end, y_, &t, CV_NORMAL) >= 0;
    }
    ERKStepSetStopTime(memory_, end);
    return ERKStepEvolve(memory_, end, y_, &t, ARK_NORMAL) >= 0;
  }

 private:
  Plantlike& plant_;
  Kind kind_;
  SUNContext context_ = nullptr;
  void* memory_ = nullptr;
  N_Vector y_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
};

/// Where nothing jumps from tick to tick the solver goes on; else it starts again, as it must.
Samples run(const Case& problem, Plantlike& plant, Kind kind, double tolerance, const Plan* plan) {
  Solver solver(plant, kind, tolerance);
  double* x = solver.state();
  std::copy(problem.psi0.begin(), problem.psi0.end(), x);
  std::copy(problem.psid0.begin(), problem.psid0.end(), x + plant.n);
  const bool smooth = problem.smooth || problem.drive == Case::Drive::continuous;
  Samples samples;
  for (int k = 0; k < problem.ticks; ++k) {
    const double t = k * problem.tick();
    if (problem.drive == Case::Drive::closed_loop)
      plant.controller.torque({plant.part(x, 0), plant.part(x, plant.n), t}, plan->at(k), plant.tau);
    else if (problem.drive == Case::Drive::table)
      problem.torque(k, plant.tau);
    if (k == 0 || !smooth) solver.start(t);
    const bool sampled = (k + 1) % problem.sample_every == 0;
    if (smooth && !sampled) continue;
    if (!solver.advance((k + 1) * problem.tick())) break;
    if (sampled) samples.emplace_back(x, x + 2 * plant.n);
  }
  return samples;
}

}  // namespace

void sundials_points(const Case& problem, const Keep& keep) {
  Plantlike plant(problem);
  std::unique_ptr<Plan> plan;
  if (problem.drive == Case::Drive::closed_loop) plan = std::make_unique<Plan>(make_plan(problem.experiment));
  struct Named {
    Kind kind;
    const char* name;
  };
  for (const auto& [kind, name] :
       {Named{Kind::adams, "CVODE Adams on our equations"}, Named{Kind::bdf, "CVODE BDF on our equations"},
        Named{Kind::erk5, "ARKODE order 5 on our equations"},
        Named{Kind::erk8, "ARKODE order 8 on our equations"}}) {
    if (kind == Kind::bdf && problem.drive == Case::Drive::continuous)
      continue;  // the Jacobian is the plant's alone
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
      char setting[40];
      std::snprintf(setting, sizeof setting, "tolerance %.0e", tolerance);
      keep(name, setting, [&] { return run(problem, plant, kind, tolerance, plan.get()); });
    }
  }
}

}  // namespace mixloop::bench
