// SPDX-License-Identifier: MIT
// Equations of motion from an energy of trigonometric polynomials.
#include <algorithm>
#include <cmath>

#include "dynamics/procedure/ldlt.hpp"
#include "dynamics/symbolic/derivative.hpp"
#include "dynamics/symbolic/evaluation_angles.hpp"
#include "dynamics/symbolic/polynomial.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {
namespace {

// How the same equations may be written down; the tracer tries and keeps the cheapest.
struct Writing {
  std::size_t basis = 0;
  std::vector<std::size_t> phase;  // of each evaluation angle, which of those worth it
  bool reverse_gradient = true;    // of the Horner scheme; else a scheme of the gradient
  bool squared_sine = true;        // s^2 = 1 - c^2; else c^2 = 1 - s^2
  bool collected = true;           // Christoffel terms of a function collected; else as (A y)(f' y)
};

// What is found once for a scene: see Writing for what is left to choose.
struct HarmonicScene {
  HarmonicEnergy energy;
  EvaluationAngles angles;
  std::vector<BlockForm> forms;
};

// Times of an addition or a product that the outputs take in a run, as estimated_time has it.
double cost_of(const Graph& graph, std::span<const NodeId> outputs) {
  const std::vector<bool> is_needed = needed(graph, outputs);
  std::vector<bool> runs(graph.size(), false);
  double cost = 0;
  for (NodeId id = 0; id < graph.size(); ++id) {
    const ExpressionNode& node = graph[id];
    if (node.op == Op::constant) continue;
    if (node.op == Op::input) {
      runs[id] = static_cast<Block>(node.a) != Block::parameter;
      continue;
    }
    runs[id] = runs[node.a] || (is_binary(node.op) && runs[node.b]);
    if (!is_needed[id] || !runs[id]) continue;
    cost += node.op == Op::div || node.op == Op::sqrt ? 5 : node.op == Op::sin || node.op == Op::cos ? 9 : 1;
  }
  return cost;
}

class HarmonicTracer final : public Tracer {
 public:
  HarmonicTracer(const Scene& scene, std::shared_ptr<const HarmonicScene> found, const Writing& writing,
                 std::vector<Expression> atoms)
      : in_(scene), found_(std::move(found)), energy_(found_->energy), angles_(found_->angles),
        form_(found_->forms[writing.basis]), writing_(writing), atoms_(std::move(atoms)), n_(scene.n()) {
    loads_ = loads_of(scene);
    place_angles();
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
    energy.potential = horner(polynomial_of(form_.potential), variables_);
    return energy;
  }

 private:
  // A function's value, and its derivatives by some angles or displacements with the rates of these.
  struct Slope {
    Expression value;
    Eigen::RowVectorXd rate;  // in the basis
  };
  struct Function {
    Expression value;
    std::vector<Slope> slopes;
  };

  static ExpressionVector times(const Eigen::MatrixXd& A, const ExpressionVector& x) {
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

  ExpressionVector from_basis(const ExpressionVector& x) const { return times(form_.B.transpose(), x); }

  // External loads do not follow from an energy: recorded from the procedure, without the bodies.
  ExpressionVector loads_of(const Scene& scene) const {
    if (scene.loads.empty()) return ExpressionVector::Constant(n_, Expression(0.0));
    auto unloaded = std::make_shared<Scene>(scene);
    unloaded->bodies.clear();
    return literal_tracer(unloaded)->bias();
  }

  // Rate of a whole combination of base angles in the basis.
  Eigen::RowVectorXd rate_of(const EvaluationAngles::Angle& angle) const {
    Eigen::Matrix<long double, 1, Eigen::Dynamic> row = Eigen::Matrix<long double, 1, Eigen::Dynamic>::Zero(n_);
    for (std::size_t g = 0; g < energy_.space.angles.size(); ++g)
      for (int k = 0; k < n_; ++k) row[k] += angle[g] * energy_.space.angles[g][static_cast<std::size_t>(k)];
    Eigen::RowVectorXd rate = (row * form_.B_inverse.cast<long double>()).cast<double>();
    for (Eigen::Index i = 0; i < rate.size(); ++i)
      if (std::fabs(rate[i]) < 1e-14 * rate.cwiseAbs().maxCoeff()) rate[i] = 0.0;
    return rate;
  }

  void place_angles() {
    const ExpressionVector u = times(form_.B, in_.psi);
    for (std::size_t e = 0; e < angles_.angles.size(); ++e) {
      rates_.push_back(rate_of(angles_.angles[e]));
      const double phase = static_cast<double>(angles_.phases[e][writing_.phase[e]]);
      const Expression angle = times(rates_.back(), u)[0] + Expression(phase);
      variables_.push_back(cos(angle));
      variables_.push_back(sin(angle));
    }
    for (int k = 0; k < n_; ++k) {
      variables_.push_back(in_.psi[k]);
      rates_.push_back(form_.B_inverse.row(k));
    }
  }

  // Re(w e^ix) of one harmonic as monomials in cosines and sines, added with the parameters' factor.
  void add_wave(const HarmonicKey& key, std::complex<long double> w, Polynomial& polynomial) const {
    using Complex = std::complex<long double>;
    const std::size_t pairs = angles_.angles.size();
    std::map<Polynomial::Exponents, Complex> expanded{{Polynomial::Exponents(variables_.size(), 0), 1.0L}};
    if (key.angle != EvaluationAngles::Angle{}) {
      const std::vector<int>& multiple = angles_.combinations.at(key.angle);
      long double phase = 0;
      for (std::size_t e = 0; e < pairs; ++e) {
        phase += multiple[e] * angles_.phases[e][writing_.phase[e]];
        for (int k = 0; k < std::abs(multiple[e]); ++k) expanded = turned(expanded, e, multiple[e] > 0 ? 1 : -1);
      }
      const long double size = std::abs(w);
      w *= std::polar(1.0L, -phase);
      if (is_round_off(w.real(), size)) w.real(0);
      if (is_round_off(w.imag(), size)) w.imag(0);
    }
    Expression factor = 1.0;
    for (std::size_t v = 0; v < atoms_.size(); ++v)
      for (int p = 0; p < key.power[static_cast<std::size_t>(n_) + v]; ++p) factor *= atoms_[v];
    for (auto& [exponents, part] : expanded) {
      Polynomial::Exponents full = exponents;
      for (int k = 0; k < n_; ++k) full[2 * pairs + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(key.power[static_cast<std::size_t>(k)]);
      polynomial.add(full, factor * Expression(static_cast<double>((w * part).real())));
    }
  }

  // Times cos + i sign sin of evaluation angle e, squares of one of them reduced.
  std::map<Polynomial::Exponents, std::complex<long double>> turned(
      const std::map<Polynomial::Exponents, std::complex<long double>>& x, std::size_t e, int sign) const {
    std::map<Polynomial::Exponents, std::complex<long double>> result;
    const std::size_t cosine = 2 * e, sine = 2 * e + 1;
    const std::size_t reduced = writing_.squared_sine ? sine : cosine, kept = writing_.squared_sine ? cosine : sine;
    const auto add = [&](Polynomial::Exponents exponents, std::complex<long double> value) {
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
      add(with, value * std::complex<long double>(0, sign));
    }
    return result;
  }

  Polynomial polynomial_of(const WaveSum& waves) const {
    Polynomial polynomial;
    for (const auto& [key, w] : waves) add_wave(key, w, polynomial);
    return polynomial;
  }

  static Polynomial without_constant(Polynomial polynomial, Expression& constant) {
    constant = 0.0;
    for (auto term = polynomial.terms.begin(); term != polynomial.terms.end(); ++term) {
      if (!std::all_of(term->first.begin(), term->first.end(), [](int e) { return e == 0; })) continue;
      constant = term->second;
      polynomial.terms.erase(term);
      break;
    }
    return polynomial;
  }

  // By each evaluation angle and each displacement that the function has.
  std::vector<Slope> slopes(const Polynomial& polynomial, const Expression& value) const {
    const std::size_t pairs = angles_.angles.size();
    std::vector<Expression> by_variable;
    if (writing_.reverse_gradient && !value.is_number()) {
      std::vector<NodeId> inputs;
      for (const Expression& variable : variables_) inputs.push_back(variable.node());
      for (NodeId node : gradient(recording_graph(), value.node(), inputs)) by_variable.push_back(Expression::of(node));
    } else {
      for (std::size_t v = 0; v < variables_.size(); ++v) by_variable.push_back(horner(polynomial.derivative(v), variables_));
    }
    std::vector<Slope> result;
    const auto add = [&](const Expression& slope, std::size_t direction) {
      if (!slope.is_number() || slope.number() != 0.0) result.push_back({slope, rates_[direction]});
    };
    for (std::size_t e = 0; e < pairs; ++e)
      add(variables_[2 * e] * by_variable[2 * e + 1] - variables_[2 * e + 1] * by_variable[2 * e], e);
    for (std::size_t k = 2 * pairs; k < variables_.size(); ++k) add(by_variable[k], k - pairs);
    return result;
  }

  // Of a single harmonic's function: by its own angle, d Re(w e^ix) / dx = Re(i w e^ix).
  std::vector<Slope> slope_of_harmonic(const WaveSum& waves) const {
    WaveSum turned_on;
    for (const auto& [key, w] : waves) turned_on[key] = w * std::complex<long double>(0, 1);
    return {{horner(polynomial_of(turned_on), variables_), rate_of(waves.begin()->first.angle)}};
  }

  bool is_single_harmonic(const WaveSum& waves) const {
    return std::all_of(waves.begin(), waves.end(), [&](const auto& wave) {
      return wave.first.angle == waves.begin()->first.angle &&
             std::all_of(wave.first.power.begin(), wave.first.power.begin() + n_, [](int p) { return p == 0; });
    });
  }

  void functions() {
    N_ = ExpressionMatrix::Constant(n_, n_, Expression(0.0));
    for (const auto& [key, sheet] : form_.constant) {
      Expression factor = 1.0;
      for (std::size_t v = 0; v < atoms_.size(); ++v)
        for (int p = 0; p < key.power[static_cast<std::size_t>(n_) + v]; ++p) factor *= atoms_[v];
      for (int i = 0; i < n_; ++i)
        for (int j = 0; j < n_; ++j) N_(i, j) += factor * Expression(sheet(i, j));
    }
    for (const WaveGroup& group : form_.groups) {
      Expression constant;
      const Polynomial polynomial = without_constant(polynomial_of(group.f), constant);
      const Expression value = horner(polynomial, variables_);
      functions_.push_back({value, is_single_harmonic(group.f) ? slope_of_harmonic(group.f) : slopes(polynomial, value)});
      add_to_mass(group, constant);
    }
    for (std::size_t g = 0; g < form_.groups.size(); ++g) add_to_mass(form_.groups[g], functions_[g].value);
    Expression constant;
    const Polynomial polynomial = without_constant(polynomial_of(form_.potential), constant);
    potential_ = {0.0, slopes(polynomial, horner(polynomial, variables_))};
  }

  void add_to_mass(const WaveGroup& group, const Expression& value) {
    const auto& block = form_.blocks[group.block];
    for (std::size_t i = 0; i < block.size(); ++i)
      for (std::size_t j = 0; j < block.size(); ++j)
        N_(block[i], block[j]) += value * Expression(group.A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }

  // h in the basis: the Christoffel terms of every f_g A_g, and the potential's gradient.
  ExpressionVector forces() {
    const ExpressionVector y = times(form_.B, in_.psid);
    ExpressionVector h = ExpressionVector::Constant(n_, Expression(0.0));
    std::vector<Slope> along = potential_.slopes;  // generalised forces along angles and displacements
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
  void add_kinetic(const WaveGroup& group, const Function& f, const ExpressionVector& y, std::vector<Slope>& along,
                   ExpressionVector& h) const {
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
  void add_collected(const WaveGroup& group, const Function& f, const ExpressionVector& y, ExpressionVector& h) const {
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
  const HarmonicEnergy& energy_;
  const EvaluationAngles& angles_;
  const BlockForm& form_;
  Writing writing_;
  std::vector<Expression> atoms_;
  int n_;
  ExpressionVector loads_;
  std::vector<Expression> variables_;      // cosine, sine of each evaluation angle; then psi, for displacements
  std::vector<Eigen::RowVectorXd> rates_;  // of each evaluation angle, then of each psi, in the basis
  ExpressionMatrix N_;
  std::vector<Function> functions_;
  Function potential_;
};

// Tries a few ways of writing forward dynamics down, each in a graph of its own: bases, then for each
// angle the phase, then the schemes, one after the other.
class WritingSearch {
 public:
  WritingSearch(const Scene& scene, std::shared_ptr<const HarmonicScene> found)
      : scene_(scene), found_(std::move(found)) {}

  Writing best() {
    Writing best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t basis = 0; basis < found_->forms.size(); ++basis) {
      Writing now;
      now.basis = basis;
      now.phase.assign(found_->angles.angles.size(), 0);
      double cost = cost_of_writing(now);
      if (cost > 1.3 * least) continue;
      for (double before = 2 * cost; cost < before;) {
        before = cost;
        cost = improve(now, cost);
      }
      if (cost < least) best = now, least = cost;
    }
    return best;
  }

 private:
  double improve(Writing& now, double cost) const {
    const auto attempt = [&](const Writing& other) {
      const double found = cost_of_writing(other);
      if (found < cost) now = other, cost = found;
    };
    for (std::size_t e = 0; e < now.phase.size(); ++e) {
      for (std::size_t p = 0; p < found_->angles.phases[e].size(); ++p) {
        Writing other = now;
        other.phase[e] = p;
        if (p != now.phase[e]) attempt(other);
      }
    }
    for (bool Writing::*choice : {&Writing::reverse_gradient, &Writing::squared_sine, &Writing::collected}) {
      Writing other = now;
      other.*choice = !(now.*choice);
      attempt(other);
    }
    return cost;
  }

  double cost_of_writing(const Writing& writing) const {
    Graph graph;
    const Recording recording(graph);
    std::vector<Expression> atoms;
    for (std::size_t i = 0; i < found_->energy.atoms.size(); ++i) atoms.push_back(Expression::input(Block::parameter, i));
    HarmonicTracer tracer(scene_, found_, writing, atoms);
    ExpressionVector tau(scene_.n());
    for (int i = 0; i < scene_.n(); ++i) tau[i] = Expression::input(Block::input, static_cast<std::size_t>(i));
    std::vector<NodeId> outputs;
    for (const Expression& x : tracer.forward_dynamics(tau)) outputs.push_back(x.node());
    return cost_of(graph, outputs);
  }

  const Scene& scene_;
  std::shared_ptr<const HarmonicScene> found_;
};

constexpr std::size_t kBasesTried = 8;

}  // namespace

std::unique_ptr<Tracer> harmonic_tracer(std::shared_ptr<const Scene> scene) {
  auto energy = harmonic_energy(scene, recording_graph());
  if (!energy) return nullptr;
  auto found = std::make_shared<HarmonicScene>();
  found->energy = std::move(*energy);
  auto angles = evaluation_angles(found->energy);
  if (!angles) return nullptr;
  found->angles = std::move(*angles);
  for (const Eigen::MatrixXd& B : candidate_bases(found->energy, kBasesTried)) found->forms.push_back(block_form(found->energy, B));
  const Writing writing = WritingSearch(*scene, found).best();
  const std::vector<Expression> atoms = found->energy.atoms;
  return std::make_unique<HarmonicTracer>(*scene, std::move(found), writing, atoms);
}

}  // namespace mixloop
