// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/harmonic_functions.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "dynamics/symbolic/derivative.hpp"

namespace mixloop {

ExpressionVector times(const Eigen::MatrixXd& A, const ExpressionVector& x) {
  ExpressionVector result(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    // Terms without a factor last: a - c b, not c b - a.
    Expression sum = 0.0;
    for (bool whole : {false, true})
      for (Eigen::Index j = 0; j < A.cols(); ++j)
        if ((std::fabs(A(i, j)) == 1.0) == whole) sum += x[j] * Expression(A(i, j));
    result[i] = sum;
  }
  return result;
}

HarmonicFunctions::HarmonicFunctions(std::shared_ptr<const HarmonicScene> found, const Writing& writing,
                                     const ExpressionVector& psi, std::vector<Expression> atoms)
    : found_(std::move(found)),
      angles_(found_->angles),
      form_(found_->forms[writing.basis]),
      writing_(writing),
      atoms_(std::move(atoms)),
      n_(static_cast<int>(psi.size())) {
  const ExpressionVector u = times(form_.B, psi);
  for (std::size_t e = 0; e < angles_.angles.size(); ++e) {
    rates_.push_back(rate_of(angles_.angles[e]));
    const double phase = static_cast<double>(angles_.phases[e][writing_.phase[e]]);
    const Expression angle = times(rates_.back(), u)[0] + Expression(phase);
    variables_.push_back(cos(angle));
    variables_.push_back(sin(angle));
  }
  for (int k = 0; k < n_; ++k) {
    variables_.push_back(psi[k]);
    rates_.push_back(form_.B_inverse.row(k));
  }
}

// Rate of a whole combination of base angles in the basis.
Eigen::RowVectorXd HarmonicFunctions::rate_of(const EvaluationAngles::Angle& angle) const {
  Eigen::Matrix<DoubleDouble, 1, Eigen::Dynamic> row =
      Eigen::Matrix<DoubleDouble, 1, Eigen::Dynamic>::Zero(n_);
  for (std::size_t g = 0; g < found_->energy.space.angles.size(); ++g)
    for (int k = 0; k < n_; ++k)
      row[k] += angle[g] * found_->energy.space.angles[g][static_cast<std::size_t>(k)];
  Eigen::RowVectorXd rate = (row * form_.B_inverse.cast<DoubleDouble>()).cast<double>();
  for (Eigen::Index i = 0; i < rate.size(); ++i)
    if (std::fabs(rate[i]) < 1e-14 * rate.cwiseAbs().maxCoeff()) rate[i] = 0.0;
  return rate;
}

Expression HarmonicFunctions::factor_of(const HarmonicKey& key) const {
  Expression factor = 1.0;
  for (std::size_t v = 0; v < atoms_.size(); ++v)
    for (int p = 0; p < key.power[static_cast<std::size_t>(n_) + v]; ++p) factor *= atoms_[v];
  return factor;
}

// e^ix of one harmonic as monomials in cosines and sines; w takes over the phases.
HarmonicFunctions::Expanded HarmonicFunctions::expanded(const EvaluationAngles::Angle& angle,
                                                        Complex& w) const {
  Expanded result{{Polynomial::Exponents(variables_.size(), 0), Complex(1)}};
  if (angle == EvaluationAngles::Angle{}) return result;
  const std::vector<int>& multiple = angles_.combinations.at(angle);
  DoubleDouble phase = 0;
  for (std::size_t e = 0; e < angles_.angles.size(); ++e) {
    phase += multiple[e] * angles_.phases[e][writing_.phase[e]];
    for (int k = 0; k < std::abs(multiple[e]); ++k) result = turned(result, e, multiple[e] > 0 ? 1 : -1);
  }
  const DoubleDouble size = std::abs(w);
  w *= std::polar(DoubleDouble(1), -phase);
  if (is_round_off(w.real(), size)) w.real(0);
  if (is_round_off(w.imag(), size)) w.imag(0);
  return result;
}

// Re(w e^ix) of one harmonic, added with the parameters' factor.
void HarmonicFunctions::add_wave(const HarmonicKey& key, Complex w, Polynomial& polynomial) const {
  const Expanded waves = expanded(key.angle, w);
  const Expression factor = factor_of(key);
  const std::size_t first = 2 * angles_.angles.size();
  for (const auto& [exponents, part] : waves) {
    Polynomial::Exponents full = exponents;
    for (std::size_t k = 0; k < static_cast<std::size_t>(n_); ++k)
      full[first + k] = static_cast<std::uint8_t>(key.power[k]);
    polynomial.add(full, factor * Expression(static_cast<double>((w * part).real())));
  }
}

// Times cos + i sign sin of evaluation angle e, squares of one of them reduced.
HarmonicFunctions::Expanded HarmonicFunctions::turned(const Expanded& x, std::size_t e, int sign) const {
  Expanded result;
  const std::size_t cosine = 2 * e, sine = 2 * e + 1;
  const std::size_t reduced = writing_.squared_sine ? sine : cosine,
                    kept = writing_.squared_sine ? cosine : sine;
  const auto add = [&](Polynomial::Exponents exponents, Complex value) {
    if (exponents[reduced] < 2) {
      result[exponents] += value;
      return;
    }
    exponents[reduced] = static_cast<std::uint8_t>(exponents[reduced] - 2);
    result[exponents] += value;
    exponents[kept] = static_cast<std::uint8_t>(exponents[kept] + 2);
    result[exponents] -= value;
  };
  for (const auto& [exponents, value] : x) {
    Polynomial::Exponents with = exponents;
    ++with[cosine];
    add(with, value);
    with = exponents;
    ++with[sine];
    add(with, value * Complex(0, sign));
  }
  return result;
}

Polynomial HarmonicFunctions::polynomial_of(const WaveSum& waves) const {
  Polynomial polynomial;
  for (const auto& [key, w] : waves) add_wave(key, w, polynomial);
  return polynomial;
}

namespace {

Polynomial without_constant(Polynomial polynomial, Expression& constant) {
  constant = 0.0;
  for (auto term = polynomial.terms.begin(); term != polynomial.terms.end(); ++term) {
    if (!std::all_of(term->first.begin(), term->first.end(), [](int e) { return e == 0; })) continue;
    constant = term->second;
    polynomial.terms.erase(term);
    break;
  }
  return polynomial;
}

}  // namespace

// By each evaluation angle and each displacement that the function has.
namespace {

// Whether each variable is a node of its own, listed in `nodes`: only then may a function of them be
// differentiated backwards through the graph. Of -sin x, which sin(-x) is recorded as, the sign may have gone
// into a coefficient, and the node of -sin x is not on the way.
bool are_leaves(const std::vector<Expression>& variables, std::vector<NodeId>& nodes) {
  for (const Expression& variable : variables) {
    const Op op = variable.is_number() ? Op::constant : recording_graph()[variable.node()].op;
    if (op != Op::sin && op != Op::cos && op != Op::input) return false;
    nodes.push_back(variable.node());
  }
  return std::set<NodeId>(nodes.begin(), nodes.end()).size() == nodes.size();
}

}  // namespace

std::vector<HarmonicSlope> HarmonicFunctions::slopes(const Polynomial& polynomial,
                                                     const Expression& value) const {
  const std::size_t pairs = angles_.angles.size();
  std::vector<Expression> by_variable;
  std::vector<NodeId> inputs;
  if (writing_.reverse_gradient && !value.is_number() && are_leaves(variables_, inputs)) {
    for (NodeId node : gradient(recording_graph(), value.node(), inputs))
      by_variable.push_back(Expression::of(node));
  } else {
    for (std::size_t v = 0; v < variables_.size(); ++v)
      by_variable.push_back(horner(polynomial.derivative(v), variables_));
  }
  std::vector<HarmonicSlope> result;
  const auto add = [&](const Expression& slope, std::size_t direction) {
    if (!slope.is_number() || slope.number() != 0.0) result.push_back({slope, rates_[direction]});
  };
  for (std::size_t e = 0; e < pairs; ++e)
    add(variables_[2 * e] * by_variable[2 * e + 1] - variables_[2 * e + 1] * by_variable[2 * e], e);
  for (std::size_t k = 2 * pairs; k < variables_.size(); ++k) add(by_variable[k], k - pairs);
  return result;
}

// Of a single harmonic's function: by its own angle, d Re(w e^ix) / dx = Re(i w e^ix).
std::vector<HarmonicSlope> HarmonicFunctions::slope_of_harmonic(const WaveSum& waves) const {
  WaveSum turned_on;
  for (const auto& [key, w] : waves) turned_on[key] = w * std::complex<DoubleDouble>(0, 1);
  return {{horner(polynomial_of(turned_on), variables_), rate_of(waves.begin()->first.angle)}};
}

bool HarmonicFunctions::is_single_harmonic(const WaveSum& waves) const {
  return !waves.empty() && std::all_of(waves.begin(), waves.end(), [&](const auto& wave) {
    return wave.first.angle == waves.begin()->first.angle &&
           std::all_of(wave.first.power.begin(), wave.first.power.begin() + n_, [](int p) { return p == 0; });
  });
}

Expression HarmonicFunctions::value(const WaveSum& waves) const {
  return horner(polynomial_of(waves), variables_);
}

Expression HarmonicFunctions::value_and_slopes(const WaveSum& waves, Expression& constant,
                                               std::vector<HarmonicSlope>& along) const {
  const Polynomial polynomial = without_constant(polynomial_of(waves), constant);
  const Expression value = horner(polynomial, variables_);
  along = is_single_harmonic(waves) ? slope_of_harmonic(waves) : slopes(polynomial, value);
  return value;
}

}  // namespace mixloop
