// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/harmonic_equations.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/procedure/ldlt.hpp"
#include "dynamics/symbolic/harmonic_functions.hpp"

namespace mixloop {
namespace {

class HarmonicTracer final : public Tracer {
 public:
  HarmonicTracer(const Scene& scene, std::shared_ptr<const HarmonicScene> found, const Writing& writing,
                 std::vector<Expression> atoms)
      : in_(scene),
        found_(std::move(found)),
        form_(found_->forms[writing.basis]),
        writing_(writing),
        n_(scene.n()),
        written_(found_, writing, in_.psi, std::move(atoms)) {
    record_loads(scene);
    functions();
  }

  ExpressionMatrix mass_matrix() override {
    const ExpressionMatrix B = form_.B.cast<Expression>();
    const ExpressionMatrix NB = N_.lazyProduct(B);
    ExpressionMatrix M(n_, n_);
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j <= i; ++j) M(i, j) = M(j, i) = B.col(i).dot(NB.col(j));
    return M;
  }
  ExpressionVector mass_times(const ExpressionVector& a) override {
    return from_basis(N_.lazyProduct(times(form_.B, a)));
  }
  ExpressionVector bias() override { return from_basis(forces()) + loads_; }
  ExpressionVector inverse_dynamics(const ExpressionVector& psidd) override {
    const ExpressionVector inertial = N_.lazyProduct(times(form_.B, psidd));
    return from_basis(inertial + forces()) + loads_;
  }
  ExpressionMatrix mass_inverse_times(const ExpressionMatrix& B) override {
    ExpressionMatrix X(B.rows(), B.cols());
    for (Eigen::Index j = 0; j < B.cols(); ++j)
      X.col(j) = times(form_.B_inverse, solve(times(form_.B_inverse.transpose(), B.col(j))));
    return X;
  }
  ExpressionVector forward_dynamics(const ExpressionVector& tau) override {
    const ExpressionVector driving = times(form_.B_inverse.transpose(), tau - loads_);
    return times(form_.B_inverse, solve(driving - forces()));
  }
  Energy<Expression> energy() override {
    const ExpressionVector y = times(form_.B, in_.psid);
    Energy<Expression> energy;
    energy.kinetic = Expression(0.5) * y.dot(N_.lazyProduct(y));
    energy.potential = written_.value(form_.potential) + springs_;
    return energy;
  }

 private:
  using Slope = HarmonicSlope;
  struct Function {
    Expression value;
    std::vector<Slope> slopes;
  };

  ExpressionVector from_basis(const ExpressionVector& x) const { return times(form_.B.transpose(), x); }

  // Loads are recorded from the procedure, without the bodies.
  void record_loads(const Scene& scene) {
    loads_ = ExpressionVector::Constant(n_, Expression(0.0));
    if (!scene.is_loaded()) return;
    auto massless = std::make_shared<Scene>(scene);
    massless->bodies.clear();
    const auto tracer = literal_tracer(massless);
    loads_ = tracer->bias();
    springs_ = tracer->energy().potential;
  }

  void functions() {
    N_ = ExpressionMatrix::Constant(n_, n_, Expression(0.0));
    for (const auto& [key, sheet] : form_.constant) {
      const Expression factor = written_.factor_of(key);
      for (int i = 0; i < n_; ++i)
        for (int j = 0; j < n_; ++j) N_(i, j) += factor * Expression(sheet(i, j));
    }
    for (const WaveGroup& group : form_.groups) {
      Expression constant;
      Function& function = functions_.emplace_back();
      function.value = written_.value_and_slopes(group.f, constant, function.slopes);
      add_to_mass(group, constant);
    }
    for (std::size_t g = 0; g < form_.groups.size(); ++g) add_to_mass(form_.groups[g], functions_[g].value);
    Expression constant;
    written_.value_and_slopes(form_.potential, constant, potential_slopes_);
  }

  void add_to_mass(const WaveGroup& group, const Expression& value) {
    const auto& block = form_.blocks[group.block];
    for (std::size_t i = 0; i < block.size(); ++i)
      for (std::size_t j = 0; j < block.size(); ++j)
        N_(block[i], block[j]) +=
            value * Expression(group.A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }

  // h in the basis: the Christoffel terms of every f_g A_g, and the potential's gradient.
  ExpressionVector forces() {
    const ExpressionVector y = times(form_.B, in_.psid);
    ExpressionVector h = ExpressionVector::Constant(n_, Expression(0.0));
    std::vector<Slope> along = potential_slopes_;  // generalised forces along angles and displacements
    for (std::size_t g = 0; g < form_.groups.size(); ++g) {
      if (writing_.collected && !stands_alone(form_.groups[g], functions_[g]))
        add_collected(form_.groups[g], functions_[g], y, h);
      else
        add_kinetic(form_.groups[g], functions_[g], y, along, h);
    }
    for (const Slope& force : along)
      for (int k = 0; k < n_; ++k) h[k] += Expression(force.rate[k]) * force.value;
    return h;
  }

  // A block of one whose own rate turns none of its function's angles: nothing to collect.
  bool stands_alone(const WaveGroup& group, const Function& f) const {
    const auto& block = form_.blocks[group.block];
    return block.size() == 1 && std::all_of(f.slopes.begin(), f.slopes.end(),
                                            [&](const Slope& slope) { return slope.rate[block[0]] == 0.0; });
  }

  static void add_force(std::vector<Slope>& along, const Expression& value, const Eigen::RowVectorXd& rate) {
    for (Slope& force : along) {
      if (force.rate != rate) continue;
      force.value += value;
      return;
    }
    along.push_back({value, rate});
  }

  // (A y) (f' . y) - 1/2 (y A y) f'
  void add_kinetic(const WaveGroup& group, const Function& f, const ExpressionVector& y,
                   std::vector<Slope>& along, ExpressionVector& h) const {
    const auto& block = form_.blocks[group.block];
    Expression rate = 0.0;
    for (const Slope& slope : f.slopes) rate += slope.value * times(slope.rate, y)[0];
    const ExpressionVector in_block = y(block);
    const ExpressionVector Ay = times(group.A, in_block);
    const Expression half = Expression(0.5) * in_block.dot(Ay);
    for (std::size_t i = 0; i < block.size(); ++i) h[block[i]] += Ay[static_cast<Eigen::Index>(i)] * rate;
    for (const Slope& slope : f.slopes) add_force(along, -half * slope.value, slope.rate);
  }

  // The same, with the coefficient of every product of two rates summed beforehand.
  void add_collected(const WaveGroup& group, const Function& f, const ExpressionVector& y,
                     ExpressionVector& h) const {
    for (const Slope& slope : f.slopes)
      for (int k = 0; k < n_; ++k) h[k] += slope.value * quadratic(christoffel(group, slope.rate, k), y);
  }

  // Q with Q(y) = (A y)_k (d . y) - 1/2 d_k y A y
  Eigen::MatrixXd christoffel(const WaveGroup& group, const Eigen::RowVectorXd& d, int k) const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_, n_);
    A(form_.blocks[group.block], form_.blocks[group.block]) = group.A;
    const Eigen::MatrixXd outer = A.row(k).transpose() * d;
    Eigen::MatrixXd Q = 0.5 * (outer + outer.transpose() - d[k] * A);
    const double size = d.cwiseAbs().maxCoeff() * A.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < Q.size(); ++i)
      if (std::fabs(Q.data()[i]) < 1e-14 * size) Q.data()[i] = 0.0;
    return Q;
  }

  Expression quadratic(const Eigen::MatrixXd& Q, const ExpressionVector& y) const {
    Polynomial polynomial;
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j <= i; ++j) {
        Polynomial::Exponents exponents(static_cast<std::size_t>(n_), 0);
        ++exponents[static_cast<std::size_t>(i)];
        ++exponents[static_cast<std::size_t>(j)];
        if (Q(i, j) != 0.0) polynomial.add(exponents, Expression(i == j ? Q(i, i) : 2 * Q(i, j)));
      }
    }
    return horner(polynomial, {y.data(), y.data() + y.size()});
  }

  // N x = b, block by block: one division for blocks of one and two, L D L^T beyond.
  ExpressionVector solve(const ExpressionVector& b) const {
    ExpressionVector x = b;
    for (const auto& block : form_.blocks) {
      if (block.size() == 1) {
        x[block[0]] = b[block[0]] / N_(block[0], block[0]);
      } else if (block.size() == 2) {
        const Expression p = N_(block[0], block[0]), q = N_(block[0], block[1]), r = N_(block[1], block[1]);
        const Expression inverse = Expression(1.0) / (p * r - q * q);
        x[block[0]] = (r * b[block[0]] - q * b[block[1]]) * inverse;
        x[block[1]] = (p * b[block[1]] - q * b[block[0]]) * inverse;
      } else {
        ExpressionMatrix L = N_(block, block);
        ExpressionVector part = b(block);
        factor_ldlt(L);
        solve_ldlt(L, part);
        x(block) = part;
      }
    }
    return x;
  }

  TracedInputs in_;
  std::shared_ptr<const HarmonicScene> found_;
  const BlockForm& form_;
  Writing writing_;
  int n_;
  ExpressionVector loads_;
  Expression springs_ = 0.0;  // their potential
  HarmonicFunctions written_;
  ExpressionMatrix N_;
  std::vector<Function> functions_;
  std::vector<Slope> potential_slopes_;
};

}  // namespace

std::unique_ptr<Tracer> harmonic_equations(const Scene& scene, std::shared_ptr<const HarmonicScene> found,
                                           const Writing& writing, std::vector<Expression> atoms) {
  return std::make_unique<HarmonicTracer>(scene, std::move(found), writing, std::move(atoms));
}

}  // namespace mixloop
