// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/harmonic_form.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace mixloop {
namespace {

using FineMatrix = Eigen::Matrix<DoubleDouble, Eigen::Dynamic, Eigen::Dynamic>;
using Complex = std::complex<DoubleDouble>;
using Row = std::vector<DoubleDouble>;

// One of the opposites (key, -key): the first angle that isn't zero is positive.
bool is_canonical(const HarmonicKey& key) {
  const auto first = std::find_if(key.angle.begin(), key.angle.end(), [](int a) { return a != 0; });
  return first == key.angle.end() || *first > 0;
}

bool is_constant_angle(const HarmonicKey& key) {
  return std::all_of(key.angle.begin(), key.angle.end(), [](int a) { return a == 0; });
}

// The coefficients of one key in all elements of the mass matrix.
struct Sheet {
  FineMatrix real, imaginary, scale;
};

std::map<HarmonicKey, Sheet> sheets_of(const HarmonicEnergy& energy) {
  const auto n = static_cast<Eigen::Index>(energy.M.size());
  std::map<HarmonicKey, Sheet> sheets;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index l = 0; l <= k; ++l) {
      for (const auto& [key, term] :
           energy.M[static_cast<std::size_t>(k)][static_cast<std::size_t>(l)].terms()) {
        if (!is_canonical(key)) continue;
        auto [found, fresh] = sheets.try_emplace(key);
        Sheet& sheet = found->second;
        if (fresh) sheet.real = sheet.imaginary = sheet.scale = FineMatrix::Zero(n, n);
        const DoubleDouble twice = is_constant_angle(key) ? 1 : 2;  // the opposite key's share
        sheet.real(k, l) = sheet.real(l, k) = twice * term.value.real();
        sheet.imaginary(k, l) = sheet.imaginary(l, k) = twice * term.value.imag();
        sheet.scale(k, l) = sheet.scale(l, k) = twice * std::abs(term.value);
      }
    }
  }
  return sheets;
}

void clean(FineMatrix& part, const FineMatrix& scale) {
  for (Eigen::Index i = 0; i < part.size(); ++i)
    if (is_round_off(part.data()[i], scale.data()[i])) part.data()[i] = 0;
}

/// B^T A B, of a few rows.
FineMatrix congruent(const FineMatrix& A, const FineMatrix& B) {
  const FineMatrix AB = A.lazyProduct(B);
  return B.transpose().lazyProduct(AB);
}

std::map<HarmonicKey, Sheet> transformed(const std::map<HarmonicKey, Sheet>& sheets,
                                         const FineMatrix& B_inverse) {
  std::map<HarmonicKey, Sheet> result;
  const FineMatrix size = B_inverse.cwiseAbs();
  for (const auto& [key, sheet] : sheets) {
    Sheet now{congruent(sheet.real, B_inverse), congruent(sheet.imaginary, B_inverse),
              congruent(sheet.scale, size)};
    clean(now.real, now.scale);
    clean(now.imaginary, now.scale);
    if (!now.real.isZero(0) || !now.imaginary.isZero(0)) result[key] = std::move(now);
  }
  return result;
}

// Indices that some key couples stand in one block.
std::vector<std::vector<int>> blocks_of(const std::map<HarmonicKey, Sheet>& sheets, int n) {
  std::vector<int> label(static_cast<std::size_t>(n));
  std::iota(label.begin(), label.end(), 0);
  for (const auto& [key, sheet] : sheets)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j)
        if (sheet.real(i, j) != 0 || sheet.imaginary(i, j) != 0) {
          const int from = label[static_cast<std::size_t>(i)], to = label[static_cast<std::size_t>(j)];
          std::replace(label.begin(), label.end(), std::max(from, to), std::min(from, to));
        }
  std::vector<std::vector<int>> blocks;
  for (int first = 0; first < n; ++first) {
    std::vector<int> block;
    for (int i = 0; i < n; ++i)
      if (label[static_cast<std::size_t>(i)] == first) block.push_back(i);
    if (!block.empty()) blocks.push_back(block);
  }
  return blocks;
}

FineMatrix within(const FineMatrix& matrix, const std::vector<int>& block) { return matrix(block, block); }

// A / x, x the most common size of its elements (of several the first): many elements become one.
Eigen::MatrixXd normalised(const FineMatrix& A, DoubleDouble& factor) {
  std::size_t most = 0;
  for (Eigen::Index i = 0; i < A.size(); ++i) {
    const DoubleDouble x = A.data()[i];
    if (x == 0) continue;
    std::size_t count = 0;
    for (Eigen::Index j = 0; j < A.size(); ++j) count += abs(abs(A.data()[j]) - abs(x)) < 1e-13 * abs(x);
    if (count > most) most = count, factor = x;
  }
  Eigen::MatrixXd result = (A / factor).cast<double>();
  for (Eigen::Index i = 0; i < result.size(); ++i) {  // ones and other whole numbers that rounding missed
    const double whole = std::round(result.data()[i]);
    if (whole != 0.0 && std::fabs(result.data()[i] - whole) < 1e-14 * std::fabs(whole))
      result.data()[i] = whole;
  }
  return result;
}

void add_to_group(BlockForm& form, std::size_t block, const HarmonicKey& key, const FineMatrix& A,
                  Complex direction) {
  if (A.isZero(0)) return;
  DoubleDouble factor = 1;
  const Eigen::MatrixXd unit = normalised(A, factor);
  for (double sign : {1.0, -1.0}) {
    for (WaveGroup& group : form.groups) {
      if (group.block != block || !(group.A - sign * unit).isZero(1e-13)) continue;
      group.f[key] += DoubleDouble(sign) * factor * direction;
      return;
    }
  }
  form.groups.push_back({block, unit, {{key, factor * direction}}});
}

}  // namespace

WaveSum waves_of(const HarmonicSum& sum) {
  WaveSum waves;
  for (const auto& [key, term] : sum.terms())
    if (is_canonical(key)) waves[key] = DoubleDouble(is_constant_angle(key) ? 1 : 2) * term.value;
  return waves;
}

BlockForm block_form(const HarmonicEnergy& energy, const Eigen::MatrixXd& B) {
  BlockForm form;
  form.B = B;
  const FineMatrix B_inverse = B.cast<DoubleDouble>().inverse();
  form.B_inverse = B_inverse.cast<double>();
  const auto sheets = transformed(sheets_of(energy), B_inverse);
  form.blocks = blocks_of(sheets, static_cast<int>(B.rows()));
  form.potential = waves_of(energy.potential);
  for (const auto& [key, sheet] : sheets) {
    const bool moves =
        !is_constant_angle(key) ||
        std::any_of(key.power.begin(), key.power.begin() + energy.space.n, [](int p) { return p != 0; });
    if (!moves) {
      form.constant[key] = sheet.real.cast<double>();
      continue;
    }
    for (std::size_t b = 0; b < form.blocks.size(); ++b) {
      // Re(w e^ix) A with one w where the real and the imaginary part are proportional.
      const FineMatrix real = within(sheet.real, form.blocks[b]),
                       imaginary = within(sheet.imaginary, form.blocks[b]);
      const DoubleDouble rr = real.squaredNorm(), ii = imaginary.squaredNorm(),
                         ri = real.cwiseProduct(imaginary).sum();
      if (ri * ri >= rr * ii * (1 - 1e-24) && rr > 0 && ii > 0) {
        const DoubleDouble ratio = ri / rr;
        add_to_group(form, b, key, real, Complex(1, ratio));
      } else {
        add_to_group(form, b, key, real, Complex(1, 0));
        add_to_group(form, b, key, imaginary, Complex(0, 1));
      }
    }
  }
  return form;
}

namespace {

// The row with its largest element scaled to one.
Row scaled(const Row& row) {
  const auto largest = std::max_element(row.begin(), row.end(),
                                        [](DoubleDouble x, DoubleDouble y) { return abs(x) < abs(y); });
  Row result = row;
  for (auto& x : result) x /= *largest;
  return result;
}

std::vector<Row> candidate_rows(const HarmonicEnergy& energy) {
  std::vector<Row> rows;
  const auto add = [&](const Row& row) {
    if (std::all_of(row.begin(), row.end(), [](DoubleDouble x) { return abs(x) < 1e-15; })) return;
    Row now = scaled(row);
    for (auto& x : now)
      if (abs(x) < 1e-15) x = 0;
    for (const Row& known : rows)
      if (std::equal(known.begin(), known.end(), now.begin(),
                     [](DoubleDouble x, DoubleDouble y) { return abs(x - y) < 1e-14; }))
        return;
    if (rows.size() < 12) rows.push_back(now);
  };
  for (const Row& axis : energy.axes) add(axis);
  for (int k = 0; k < energy.space.n; ++k) {
    Row unit(static_cast<std::size_t>(energy.space.n), 0);
    unit[static_cast<std::size_t>(k)] = 1;
    add(unit);
  }
  return rows;
}

// What an evaluation in this basis is bound to take: elements of N, solving its blocks, the basis itself.
double burden(const std::map<HarmonicKey, Sheet>& sheets, const FineMatrix& B) {
  double cost = 0;
  for (const auto& [key, sheet] : sheets)
    for (Eigen::Index i = 0; i < B.rows(); ++i)
      for (Eigen::Index j = 0; j <= i; ++j) cost += (sheet.real(i, j) != 0) + (sheet.imaginary(i, j) != 0);
  for (const auto& block : blocks_of(sheets, static_cast<int>(B.rows())))
    cost += std::pow(static_cast<double>(block.size()), 3) / 2;
  for (Eigen::Index i = 0; i < B.size(); ++i)
    cost += (B.data()[i] != 0) + (abs(abs(B.data()[i]) - 1) > 1e-14 && B.data()[i] != 0);
  return cost;
}

}  // namespace

std::vector<Eigen::MatrixXd> candidate_bases(const HarmonicEnergy& energy, std::size_t most) {
  const auto n = static_cast<std::size_t>(energy.space.n);
  const std::vector<Row> rows = candidate_rows(energy);
  const auto sheets = sheets_of(energy);
  std::vector<std::pair<double, Eigen::MatrixXd>> found;
  std::vector<bool> chosen(rows.size(), false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(n), true);
  do {
    FineMatrix B(n, n);
    Eigen::Index i = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!chosen[r]) continue;
      for (std::size_t k = 0; k < n; ++k) B(i, static_cast<Eigen::Index>(k)) = rows[r][k];
      ++i;
    }
    if (abs(B.determinant()) < 1e-6) continue;
    const FineMatrix inverse = B.inverse();
    // A basis of nearly dependent rates would cost digits.
    if (B.norm() * inverse.norm() > 4 * DoubleDouble(n)) continue;
    found.emplace_back(burden(transformed(sheets, inverse), B), B.cast<double>());
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  std::vector<Eigen::MatrixXd> bases;
  for (std::size_t i = 0; i < std::min(most, found.size()); ++i) bases.push_back(found[i].second);
  return bases;
}

}  // namespace mixloop
