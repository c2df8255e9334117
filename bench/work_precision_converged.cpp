// SPDX-License-Identifier: MIT
// The motions in 113 bits, by DOP853 and by Gauss collocation of order 12.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bench/papers_path.hpp"
#include "bench/work_precision.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "integrators/dop853.hpp"
#include "integrators/gauss.hpp"
#include "tests/oracles/known_linkages.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop::bench {
namespace {

using oracle::Wide;
using WideVector = Vec<Wide>;
using WideSamples = std::vector<WideVector>;

/// The plant and its controller, the procedure itself on wide floats.
class WideLoop {
 public:
  explicit WideLoop(const Case& problem)
      : case_(problem),
        n_(problem.n()),
        model_(make_model<Wide>(problem.experiment.scene, wide(problem.experiment.plant_parameters))),
        ws_(model_),
        tau_(n_) {
    if (problem.drive == Case::Drive::closed_loop)
      plan_ = std::make_unique<Plan>(make_plan(problem.experiment));
  }

  template <class Method>
  WideSamples run(int steps) {
    Method method(n_, 2 * n_);
    WideVector x(2 * n_);
    for (int i = 0; i < n_; ++i) {
      x[i] = case_.psi0[static_cast<std::size_t>(i)];
      x[n_ + i] = case_.psid0[static_cast<std::size_t>(i)];
    }
    WideSamples samples;
    const Wide tick = Wide(1) / Wide(case_.experiment.rate_hz), h = tick / steps;
    for (int k = 0; k < case_.ticks; ++k) {
      hold(k, x);
      method.begin();
      for (int step = 0; step < steps; ++step)
        method.step(x, h, [&](int, const Wide& c, const WideVector& at, WideVector& dx) {
          rate(tick * k + (step + c) * h, at, dx);
        });
      if ((k + 1) % case_.sample_every == 0) samples.push_back(x);
    }
    return samples;
  }

 private:
  static std::vector<Wide> wide(const std::vector<double>& values) { return {values.begin(), values.end()}; }
  std::span<const Wide> part(const WideVector& x, int from) const {
    return {x.data() + from, static_cast<std::size_t>(n_)};
  }

  /// The torque of tick k.
  void hold(int k, const WideVector& x) {
    if (case_.drive == Case::Drive::table) {
      std::vector<double> tau(static_cast<std::size_t>(n_));
      case_.torque(k, tau);
      for (int i = 0; i < n_; ++i) tau_[i] = tau[static_cast<std::size_t>(i)];
    } else if (case_.drive == Case::Drive::closed_loop) {
      const Reference at = plan_->at(k);
      control(x, at.psi.cast<Wide>(), at.psid.cast<Wide>(), at.psidd.cast<Wide>());
    }
  }

  // (33)
  void control(const WideVector& x, const WideVector& psi, const WideVector& psid, const WideVector& psidd) {
    const auto& settings = case_.experiment.controller;
    const auto& M = mass_matrix<Wide>(model_, part(x, 0), Wide(0), ws_);
    for (int i = 0; i < n_; ++i) {
      tau_[i] = Wide(settings.kp[i]) * (psi[i] - x[i]) + Wide(settings.kv[i]) * (psid[i] - x[n_ + i]);
      for (int j = 0; j < n_; ++j) tau_[i] += M(i, j) * psidd[j];
    }
  }

  void rate(const Wide& t, const WideVector& x, WideVector& dx) {
    if (case_.drive == Case::Drive::continuous) {
      const auto at = papers_reference<Wide>(t);
      control(x, at.psi, at.psid, at.psidd);
    }
    dx.head(n_) = x.tail(n_);
    dx.tail(n_) =
        forward_dynamics<Wide>(model_, part(x, 0), part(x, n_), span_of(std::as_const(tau_)), t, ws_);
  }

  const Case& case_;
  int n_;
  Model<Wide> model_;
  Workspace<Wide> ws_;
  WideVector tau_;
  std::unique_ptr<Plan> plan_;
};

/// The seven-body mechanism with all its angles, by Lagrange's equations with multipliers: its crank.
class WideLinkage {
 public:
  explicit WideLinkage(const Case& problem) : case_(problem), linkage_(oracle::seven_bodies<Wide>()) {}

  template <class Method>
  WideSamples run(int steps) {
    const int n = linkage_.angles;
    Method method(n, 2 * n);
    WideVector q = oracle::seven_bodies_start<Wide>(), torque = WideVector::Zero(n), x(2 * n);
    oracle::close(linkage_, q);
    x << q, WideVector::Zero(n);
    torque[0] = oracle::decimal<Wide>("0.033");
    const Wide h = Wide(1) / Wide(case_.experiment.rate_hz) / steps;
    WideSamples samples;
    for (int k = 0; k < case_.ticks; ++k) {
      method.begin();
      for (int step = 0; step < steps; ++step)
        method.step(x, h, [&](int, const Wide&, const WideVector& at, WideVector& dx) {
          dx.head(n) = at.tail(n);
          dx.tail(n) = oracle::linkage_accelerations<Wide>(linkage_, at.head(n), at.tail(n), torque);
        });
      samples.push_back(WideVector(2));
      samples.back() << x[0], x[n];
    }
    return samples;
  }

 private:
  const Case& case_;
  oracle::Linkage<Wide> linkage_;
};

std::string file_of(const Case& problem) {
  return std::string(MIXLOOP_CONVERGED) + "/" + problem.name + ".txt";
}

/// The largest difference, as a share of the largest size of each number.
double disagreement(const WideSamples& a, const WideSamples& b) {
  Wide worst = 0;
  for (Eigen::Index i = 0; i < a[0].size(); ++i) {
    Wide size = 0, difference = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      size = std::max(size, Wide(abs(a[k][i])));
      difference = std::max(difference, Wide(abs(a[k][i] - b[k][i])));
    }
    // A number that stays at rest is held against 1.
    worst = std::max(worst, Wide(difference / (size > 1e-12 ? size : Wide(1))));
  }
  return static_cast<double>(worst);
}

template <class Loop>
std::pair<WideSamples, WideSamples> by_two_methods(Loop loop, const int (&steps)[2]) {
  return {loop.template run<Dop853<Wide>>(steps[0]), loop.template run<Gauss<Wide, 6>>(steps[1])};
}

}  // namespace

void converge(const Case& problem) {
  const auto [dop853, gauss] = problem.by_multipliers
                                   ? by_two_methods(WideLinkage(problem), problem.converged_steps)
                                   : by_two_methods(WideLoop(problem), problem.converged_steps);
  const double apart = disagreement(dop853, gauss);
  std::ofstream out(file_of(problem));
  out << "# " << problem.title << "\n# psi and psi' every " << problem.sample_every
      << " ticks, in 113 bits by DOP853 and Gauss collocation of order 12, which differ by " << apart
      << "; mixloop-bench-work-precision --converge " << problem.name << " writes this file\n";
  for (const auto& x : gauss) {
    for (Eigen::Index i = 0; i < x.size(); ++i)
      out << (i ? " " : "") << x[i].str(20, std::ios_base::scientific);
    out << "\n";
  }
  std::printf("%s: the two methods differ by %.1e\n", problem.name.c_str(), apart);
}

Samples converged_samples(const Case& problem) {
  std::ifstream in(file_of(problem));
  Samples samples;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::vector<double> row(static_cast<std::size_t>(2 * problem.n()));
    for (double& value : row) words >> value;
    if (!words) throw std::runtime_error("cannot read a line of " + file_of(problem));
    samples.push_back(std::move(row));
  }
  if (samples.size() != static_cast<std::size_t>(problem.ticks / problem.sample_every))
    throw std::runtime_error(file_of(problem) + " has not the samples of the problem: run with --converge " +
                             problem.name);
  return samples;
}

double error_of(const Samples& samples, const Samples& converged) {
  double worst = 0;
  for (std::size_t i = 0; i < converged[0].size(); ++i) {
    double size = 0, difference = 0;
    for (std::size_t k = 0; k < converged.size(); ++k) {
      const double d = k < samples.size() ? std::abs(samples[k][i] - converged[k][i]) : HUGE_VAL;
      if (!std::isfinite(d)) return HUGE_VAL;
      size = std::max(size, std::abs(converged[k][i]));
      difference = std::max(difference, d);
    }
    // A number that stays at rest is held against 1.
    worst = std::max(worst, difference / (size > 1e-12 ? size : 1.0));
  }
  return worst;
}

}  // namespace mixloop::bench
