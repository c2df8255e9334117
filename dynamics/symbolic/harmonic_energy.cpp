// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/harmonic_energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "dynamics/procedure/constraints.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kTermBudget = 48;  // terms of one element of a transform

struct OutOfBudget {};  // caught in harmonic_energy

using Row = std::vector<DoubleDouble>;
using Angle = std::array<std::int16_t, kMostBaseAngles>;

// A coordinate as an affine function of psi.
struct Affine {
  Row slope;
  DoubleDouble offset = 0;
};

// p/q within round-off of x, q small.
std::optional<std::pair<long, long>> rational(DoubleDouble x) {
  long p0 = 0, q0 = 1, p1 = 1, q1 = 0;
  DoubleDouble rest = x;
  for (int i = 0; i < 20; ++i) {
    const DoubleDouble whole = floor(rest);
    if (abs(whole) > 1e6) return std::nullopt;
    const long p2 = static_cast<long>(whole) * p1 + p0, q2 = static_cast<long>(whole) * q1 + q0;
    if (q2 > 5000) return std::nullopt;
    if (abs(DoubleDouble(p2) / q2 - x) <= 1e-14 * abs(x)) return std::pair{p2, q2};
    p0 = p1, q0 = q1, p1 = p2, q1 = q2;
    rest = 1 / (rest - whole);
  }
  return std::nullopt;
}

class EnergyMaker {
 public:
  EnergyMaker(const std::shared_ptr<const Scene>& scene, Graph& graph)
      : scene_(scene),
        graph_(graph),
        in_(*scene),
        model_(make_model<Expression>(scene, std::span<const Expression>(in_.parameters))),
        n_(scene->n()) {}

  std::optional<HarmonicEnergy> make() {
    if (n_ > kMostBaseAngles - 2 || !find_coordinates() || !choose_base_angles()) return std::nullopt;
    made_.space.n = n_;
    transforms();
    mass_matrix();
    potential();
    return std::move(made_);
  }

 private:
  using Matrix34 = std::array<std::array<HarmonicSum, 4>, 3>;

  // (1) as Q = slope Psi + offset, where it is of that form.
  bool find_coordinates() {
    Workspace<Expression> workspace(model_);
    coordinates<Expression>(model_, span_of(in_.psi), in_.t, workspace);
    for (int j = 0; j < scene_->m(); ++j) {
      const AffineSum sum = graph_.affine(workspace.q[j].node());
      Affine q{Row(static_cast<std::size_t>(n_), 0), sum.constant};
      for (const auto& [node, factor] : sum.terms) {
        const auto& leaf = graph_[node];
        if (leaf.op != Op::input || static_cast<Block>(leaf.a) != Block::psi) return false;
        q.slope[leaf.b] = factor;
      }
      coordinates_.push_back(std::move(q));
    }
    return true;
  }

  // Base angles psi_k / D_k, in which every joint angle is a whole combination; where a factor is no
  // simple fraction, the joint angles themselves.
  bool choose_base_angles() {
    std::vector<Row> rows;
    for (const auto& link : model_.links) {
      if (link.coordinate < 0) continue;
      if (!link.scale.is_number()) return false;
      if (link.prismatic) continue;
      if (!link.theta.is_number()) return false;
      Row row = coordinates_[static_cast<std::size_t>(link.coordinate)].slope;
      for (auto& x : row) x *= DoubleDouble(link.scale.number());
      rows.push_back(row);
    }
    is_rational_ = rational_base(rows);
    if (!is_rational_) irrational_base(rows);
    return made_.space.angles.size() <= kMostBaseAngles;
  }

  bool rational_base(const std::vector<Row>& rows) {
    std::vector<long> denominator(static_cast<std::size_t>(n_), 1);
    for (const Row& row : rows) {
      for (std::size_t k = 0; k < row.size(); ++k) {
        const auto fraction = rational(row[k]);
        if (!fraction) return false;
        denominator[k] = std::lcm(denominator[k], fraction->second);
        if (denominator[k] > 5000) return false;
      }
    }
    for (std::size_t k = 0; k < denominator.size(); ++k) {
      Row angle(static_cast<std::size_t>(n_), 0);
      angle[k] = 1.0 / denominator[k];
      made_.space.angles.push_back(angle);
    }
    return true;
  }

  void irrational_base(const std::vector<Row>& rows) {
    for (const Row& row : rows)
      if (std::find(made_.space.angles.begin(), made_.space.angles.end(), row) == made_.space.angles.end())
        made_.space.angles.push_back(row);
  }

  // The whole combination of base angles that a row is.
  Angle angle_of(const Row& row) const {
    Angle angle{};
    const auto& base = made_.space.angles;
    if (!is_rational_) {
      angle[static_cast<std::size_t>(std::find(base.begin(), base.end(), row) - base.begin())] = 1;
      return angle;
    }
    for (std::size_t k = 0; k < row.size(); ++k) {
      const DoubleDouble whole = round(row[k] / base[k][k]);
      if (abs(whole) > 30000) throw OutOfBudget{};
      angle[k] = static_cast<std::int16_t>(static_cast<long>(whole));
    }
    return angle;
  }

  // A number, or a power of an atom for what depends on parameters.
  HarmonicSum sum_of(const Expression& x) {
    if (x.is_number()) return HarmonicSum(x.number());
    for (std::size_t i = 0; i < made_.atoms.size(); ++i)
      if (made_.atoms[i].node() == x.node()) return HarmonicSum::power(n_ + static_cast<int>(i));
    if (n_ + made_.atoms.size() >= kMostPowers) throw OutOfBudget{};
    made_.atoms.push_back(x);
    return HarmonicSum::power(n_ + static_cast<int>(made_.atoms.size()) - 1);
  }

  static HarmonicSum product(const HarmonicSum& a, const HarmonicSum& b) {
    HarmonicSum result;
    result.add_product(a, b);
    return result;
  }

  // with its varying parameter as a harmonic sum.
  std::array<HarmonicSum, 3> cos_sin_shift(const Model<Expression>::Link& link) {
    if (link.coordinate < 0) return {sum_of(link.cos_theta), sum_of(link.sin_theta), sum_of(link.s)};
    const Affine& q = coordinates_[static_cast<std::size_t>(link.coordinate)];
    const DoubleDouble scale = link.scale.number();
    Row row = q.slope;
    for (auto& x : row) x *= scale;
    if (!link.prismatic) {
      const Angle angle = angle_of(row);
      const DoubleDouble phase = scale * q.offset + link.theta.number();
      return {HarmonicSum::cosine(angle, phase), HarmonicSum::sine(angle, phase), sum_of(link.s)};
    }
    HarmonicSum shift = sum_of(link.s);
    shift += HarmonicSum(scale * q.offset);
    for (int k = 0; k < n_; ++k) {
      HarmonicSum part = HarmonicSum::power(k);
      part *= row[static_cast<std::size_t>(k)];
      if (row[static_cast<std::size_t>(k)] != 0) shift += part;
    }
    return {sum_of(link.cos_theta), sum_of(link.sin_theta), shift};
  }

  Matrix34 transform(const Model<Expression>::Link& link) {
    const auto [c, s, d] = cos_sin_shift(link);
    const HarmonicSum ca = sum_of(link.cos_alpha), sa = sum_of(link.sin_alpha), a = sum_of(link.a);
    HarmonicSum s_ca = product(s, ca), c_sa = product(c, sa);
    s_ca *= -1, c_sa *= -1;
    return {{{c, s_ca, product(s, sa), product(a, c)},
             {s, product(c, ca), c_sa, product(a, s)},
             {HarmonicSum(), sa, ca, d}}};
  }

  static Matrix34 times(const Matrix34& X, const Matrix34& A) {
    Matrix34 result;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        HarmonicSum& element = result[i][j];
        for (std::size_t k = 0; k < 3; ++k) element.add_product(X[i][k], A[k][j]);
        if (j == 3) element += X[i][3];
        element.clean();
        if (element.size() > kTermBudget) throw OutOfBudget{};
      }
    }
    return result;
  }

  // (6), and the rates of the axes that stand parallel in a row.
  void transforms() {
    Matrix34 ground;
    for (std::size_t i = 0; i < 3; ++i) ground[i][i] = HarmonicSum(1);
    frames_.push_back(ground);
    const Row none(static_cast<std::size_t>(n_), 0);
    std::vector<Row> turning{none};  // of each frame: rate about its last axis since the axes were parallel
    for (const auto& link : model_.links) {
      const auto parent = static_cast<std::size_t>(link.parent);
      frames_.push_back(times(frames_[parent], transform(link)));
      Row rate = turning[parent];
      if (link.coordinate >= 0) {
        Row own = coordinates_[static_cast<std::size_t>(link.coordinate)].slope;
        for (std::size_t k = 0; k < own.size(); ++k) {
          own[k] *= DoubleDouble(link.scale.number());
          if (!link.prismatic) rate[k] += own[k];
        }
        made_.axes.push_back(own);
        made_.axes.push_back(rate);
      }
      const bool parallel = link.sin_alpha.is_number() && link.sin_alpha.number() == 0.0;
      turning.push_back(parallel ? rate : none);
    }
  }

  using Matrix4 = std::array<std::array<HarmonicSum, 4>, 4>;

  // The pseudo-inertia J of a body: integral of r r^T dm, r homogeneous.
  Matrix4 pseudo_inertia(const Model<Expression>::Body& body) {
    const HarmonicSum mass = sum_of(body.mass);
    std::array<HarmonicSum, 3> moment;
    std::array<HarmonicSum, 3> center;
    for (std::size_t i = 0; i < 3; ++i) {
      center[i] = sum_of(body.center_of_mass[static_cast<Eigen::Index>(i)]);
      moment[i] = product(mass, center[i]);
    }
    Matrix4 J;
    HarmonicSum trace;
    for (Eigen::Index i = 0; i < 3; ++i) trace += sum_of(body.inertia(i, i));
    trace *= 0.5;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        J[i][j].add_product(moment[i], center[j]);
        J[i][j] -= sum_of(body.inertia(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
        if (i == j) J[i][j] += trace;
        J[i][j].clean();
      }
      J[i][3] = J[3][i] = moment[i];
    }
    J[3][3] = mass;
    return J;
  }

  // M_kl = sum tr(T_k J T_l^T)
  void mass_matrix() {
    made_.M.resize(static_cast<std::size_t>(n_));
    for (int k = 0; k < n_; ++k) made_.M[static_cast<std::size_t>(k)].resize(static_cast<std::size_t>(k) + 1);
    for (const auto& body : model_.bodies) {
      const Matrix34& T = frames_[static_cast<std::size_t>(body.frame)];
      const Matrix4 J = pseudo_inertia(body);
      std::vector<Matrix34> dT(static_cast<std::size_t>(n_));
      for (int k = 0; k < n_; ++k)
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 4; ++j)
            dT[static_cast<std::size_t>(k)][i][j] = T[i][j].derivative(made_.space, k);
      for (std::size_t k = 0; k < dT.size(); ++k) {
        const Matrix34 dTJ = times_inertia(dT[k], J);
        for (std::size_t l = 0; l <= k; ++l)
          for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 4; ++j) made_.M[k][l].add_product(dTJ[i][j], dT[l][i][j]);
      }
    }
    for (auto& row : made_.M)
      for (auto& element : row) element.clean();
  }

  static Matrix34 times_inertia(const Matrix34& dT, const Matrix4& J) {
    Matrix34 result;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k) result[i][j].add_product(dT[i][k], J[k][j]);
    return result;
  }

  // V = -sum m g . p
  void potential() {
    for (const auto& body : model_.bodies) {
      const Matrix34& T = frames_[static_cast<std::size_t>(body.frame)];
      const HarmonicSum mass = sum_of(body.mass);
      for (std::size_t i = 0; i < 3; ++i) {
        HarmonicSum place = T[i][3];
        for (std::size_t j = 0; j < 3; ++j)
          place.add_product(T[i][j], sum_of(body.center_of_mass[static_cast<Eigen::Index>(j)]));
        HarmonicSum weight = product(mass, sum_of(model_.gravity[static_cast<Eigen::Index>(i)]));
        weight *= -1;
        made_.potential.add_product(weight, place);
      }
    }
    made_.potential.clean();
  }

  std::shared_ptr<const Scene> scene_;
  Graph& graph_;
  TracedInputs in_;
  Model<Expression> model_;
  int n_;
  std::vector<Affine> coordinates_;
  std::vector<Matrix34> frames_;
  HarmonicEnergy made_;
  bool is_rational_ = true;  ///< the base angles are fractions of psi's elements
};

}  // namespace

std::optional<HarmonicEnergy> harmonic_energy(const std::shared_ptr<const Scene>& scene, Graph& graph) {
  try {
    return EnergyMaker(scene, graph).make();
  } catch (const OutOfBudget&) {
    return std::nullopt;
  }
}

}  // namespace mixloop
