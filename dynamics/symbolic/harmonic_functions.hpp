// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "dynamics/symbolic/harmonic_writing.hpp"
#include "dynamics/symbolic/polynomial.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {

/// A x, constant A.
ExpressionVector times(const Eigen::MatrixXd& A, const ExpressionVector& x);

/// A function's derivative along an angle or a displacement, and that one's rate in the basis (a row).
struct HarmonicSlope {
  Expression value;
  Eigen::RowVectorXd rate;
};

/// Wave sums as expressions: polynomials in the sines and cosines of the evaluation angles, in the
/// displacements and in the parameters' atoms. Used while a Recording lives.
class HarmonicFunctions {
 public:
  HarmonicFunctions(std::shared_ptr<const HarmonicScene> found, const Writing& writing,
                    const ExpressionVector& psi, std::vector<Expression> atoms);

  /// The value of the waves.
  Expression value(const WaveSum& waves) const;
  /// The same without its constant term, which goes to `constant`, and with the slopes of what is left.
  Expression value_and_slopes(const WaveSum& waves, Expression& constant,
                              std::vector<HarmonicSlope>& slopes) const;
  /// The parameters' factor of a key.
  Expression factor_of(const HarmonicKey& key) const;

 private:
  using Complex = std::complex<DoubleDouble>;
  using Expanded = std::map<Polynomial::Exponents, Complex>;

  Eigen::RowVectorXd rate_of(const EvaluationAngles::Angle& angle) const;
  void add_wave(const HarmonicKey& key, Complex w, Polynomial& polynomial) const;
  Expanded expanded(const EvaluationAngles::Angle& angle, Complex& w) const;
  Expanded turned(const Expanded& x, std::size_t e, int sign) const;
  Polynomial polynomial_of(const WaveSum& waves) const;
  std::vector<HarmonicSlope> slopes(const Polynomial& polynomial, const Expression& value) const;
  std::vector<HarmonicSlope> slope_of_harmonic(const WaveSum& waves) const;
  bool is_single_harmonic(const WaveSum& waves) const;

  std::shared_ptr<const HarmonicScene> found_;
  const EvaluationAngles& angles_;
  const BlockForm& form_;
  Writing writing_;
  std::vector<Expression> atoms_;
  int n_;
  std::vector<Expression> variables_;  // cosine, sine of each evaluation angle; then psi, for displacements
  std::vector<Eigen::RowVectorXd> rates_;  // of each evaluation angle, then of each psi, in the basis
};

}  // namespace mixloop
