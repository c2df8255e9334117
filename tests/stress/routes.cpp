// SPDX-License-Identifier: MIT
#include "tests/stress/routes.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"
#include "tests/dynamics/program/certification.hpp"
#include "tests/stress/figure.hpp"

namespace mixloop::stress {

std::string State::text() const {
  return text_of("psi", psi) + "; " + text_of("psid", psid) + "; " + text_of("input", input) +
         "; t = " + std::to_string(t);
}

std::vector<double> uniform(std::mt19937_64& random, int size, double scale) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> values;
  for (int i = 0; i < size; ++i) values.push_back(scale * unit(random));
  return values;
}

double log_uniform(std::mt19937_64& random, double low, double high) {
  return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
}

std::vector<Route> routes(const std::shared_ptr<const Scene>& scene, Purpose purpose, bool machine_code) {
  std::vector<Route> all;
  all.emplace_back("reference", reference_routine(scene, purpose));
  const Program program = trace(scene, purpose).program;
  all.emplace_back("interpreter", std::make_unique<Interpreter>(program));
  if (!machine_code) return all;
  std::string complaint;
  const std::string key = std::string(name_of(purpose)) + "\n" + scene->canonical;
  if (auto code = MachineCode::load(
          key, [&] { return program; }, complaint))
    all.emplace_back("machine_code", std::move(code));
  return all;
}

namespace {

/// What one body adds.
struct BodySizes {
  Vector g, k;  ///< n
  double linear = 0, angular = 0, angle = 0;
};

BodySizes body_sizes(const Model<double>& model, const Workspace<double>& ws, const State& state, int frame,
                     const Vec3<double>& point) {
  BodySizes body{Vector::Zero(model.n()), Vector::Zero(model.n())};
  double R = point.norm(), w = 0, v = 0, b = 0, b_linear = 0;
  for (int at = frame; at != 0;) {
    const auto& link = model.links[static_cast<std::size_t>(at - 1)];
    R += std::abs(link.a) + std::abs(link.s);
    at = link.parent;
    if (link.coordinate < 0) continue;
    const int j = link.coordinate;
    const double scale = std::abs(link.scale);
    double terms = std::abs(ws.q[j]);
    for (int i = 0; i < model.n(); ++i)
      terms += std::abs(ws.C(j, i) * state.psi[static_cast<std::size_t>(i)]);
    if (link.prismatic)
      R += scale * terms, v += scale * std::abs(ws.qd[j]), b_linear += scale * std::abs(ws.q_bias[j]);
    else
      body.angle += scale * terms, w += scale * std::abs(ws.qd[j]), b += scale * std::abs(ws.q_bias[j]);
    const Vector column = scale * ws.C.row(j).cwiseAbs().transpose();
    (link.prismatic ? body.g : body.k) += column;
  }
  body.g += R * body.k;
  body.linear = R * w * w + 2 * w * v + R * b + b_linear;
  body.angular = w * w + b;
  return body;
}

double evaluated(const Formula& formula, const Model<double>& model, double t) {
  return evaluate<double>(formula, [&](int symbol) {
    return symbol == Symbols::kTime
               ? t
               : model.parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)];
  });
}

}  // namespace

Sizes sizes(const Model<double>& model, const State& state, Workspace<double>& ws) {
  coordinates<double>(model, state.psi, state.t, ws);
  coordinate_rates<double>(model, state.psi, state.psid, state.t, ws);
  Sizes sum{Vector::Zero(model.n()), Vector::Zero(model.n())};
  for (const auto& body : model.bodies) {
    const BodySizes part = body_sizes(model, ws, state, body.frame, body.center_of_mass);
    const double I = body.inertia.norm();
    sum.M += body.mass * part.g.cwiseAbs2() + I * part.k.cwiseAbs2();
    sum.h += body.mass * (part.linear + model.gravity.norm()) * part.g + I * part.angular * part.k;
    sum.angle = std::max(sum.angle, part.angle);
  }
  sum.M = sum.M.cwiseSqrt();
  for (std::size_t l = 0; l < model.loads.size(); ++l) {
    const BodySizes part = body_sizes(model, ws, state, model.loads[l].frame, model.loads[l].point);
    double force = 0, moment = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      force += std::abs(evaluated(model.scene->loads[l].force[i], model, state.t));
      moment += std::abs(evaluated(model.scene->loads[l].moment[i], model, state.t));
    }
    sum.h += force * part.g + moment * part.k;
  }
  for (const auto& load : model.coordinate_loads) {
    const int j = load.coordinate;
    sum.h +=
        (load.stiffness * (std::abs(ws.q[j]) + std::abs(load.rest)) + load.damping * std::abs(ws.qd[j])) *
        ws.C.row(j).cwiseAbs().transpose();
  }
  return sum;
}

Ruler::Ruler(std::shared_ptr<const Scene> scene, std::vector<double> parameters)
    : scene_(std::move(scene)),
      parameters_(std::move(parameters)),
      model_(
          std::make_unique<Model<double>>(make_model<double>(scene_, std::span<const double>(parameters_)))),
      ws_(std::make_unique<Workspace<double>>(*model_)) {}
Ruler::~Ruler() = default;

double Ruler::unit(const Sizes& sizes) {
  return std::numeric_limits<double>::epsilon() * (1 + sizes.angle / 32);
}

Sizes Ruler::sizes_at(const State& state) { return sizes(*model_, state, *ws_); }

namespace {

testing::Sample sample_of(const State& state) { return {state.psi, state.psid, state.input, state.t}; }

double norm_over(const std::vector<double>& x, const Vector& scale) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::pow(x[i] * scale[static_cast<Eigen::Index>(i)], 2);
  return std::sqrt(sum);
}

}  // namespace

double Ruler::inverse_norm(const State& state, const Sizes& sizes) {
  const auto M = testing::oracle(scene_, parameters_, Purpose::mass_matrix, sample_of(state)).value;
  const Eigen::Index n = sizes.M.size();
  Mat<Wide> L(n, n), inverse(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i)
      L(i, j) = M[static_cast<std::size_t>(i + j * n)] / (Wide(sizes.M[i]) * sizes.M[j]);
  const Wide norm = L.norm();
  factor_ldlt(L);
  for (Eigen::Index j = 0; j < n; ++j) {
    Vec<Wide> column = Vec<Wide>::Unit(n, j);
    solve_ldlt(L, column);
    inverse.col(j) = column;
  }
  condition_ = static_cast<double>(norm * inverse.norm());
  return static_cast<double>(inverse.norm());
}

double Ruler::unit_of_acceleration(const State& state, std::span<const double> psidd,
                                   std::span<const double> tau) {
  const Sizes sizes = sizes_at(state);
  const Vector over = sizes.M.cwiseInverse();
  std::vector<double> h(sizes.h.begin(), sizes.h.end());
  return unit(sizes) * inverse_norm(state, sizes) *
         (norm_over({psidd.begin(), psidd.end()}, sizes.M) + norm_over(h, over) +
          norm_over({tau.begin(), tau.end()}, over));
}

double Ruler::error(Purpose purpose, const State& state, std::span<const double> outputs) {
  for (const double x : outputs)
    if (!std::isfinite(x)) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<std::size_t>(scene_->n());
  State cut = state;
  cut.input.resize(2 * n);
  const auto exact = testing::oracle(scene_, parameters_, purpose, sample_of(cut)).value;
  const Sizes size = sizes_at(state);
  const auto M = [&](std::size_t i) { return size.M[static_cast<Eigen::Index>(i)]; };
  const auto h = [&](std::size_t i) { return size.h[static_cast<Eigen::Index>(i)]; };
  const double eps = unit(size);
  std::vector<double> error, value;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    error.push_back(static_cast<double>(Wide(outputs[k]) - exact[k]));
    value.push_back(static_cast<double>(exact[k]));
  }
  if (purpose == Purpose::forward_dynamics)
    return norm_over(error, size.M) / unit_of_acceleration(state, value, std::span(state.input).first(n));
  double worst = 0, moved = 0;
  for (std::size_t j = 0; j < n; ++j) moved += M(j) * std::abs(cut.input[j]);
  for (std::size_t k = 0; k < error.size(); ++k) {
    const double unit = purpose == Purpose::mass_matrix ? M(k % n) * M(k / n)
                        : purpose == Purpose::bias      ? h(k)
                                                        : M(k) * moved + h(k);
    if (error[k] != 0) worst = std::max(worst, std::abs(error[k]) / (eps * unit));
  }
  return worst;
}

}  // namespace mixloop::stress
