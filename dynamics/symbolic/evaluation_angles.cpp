// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/evaluation_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "dynamics/procedure/decompositions.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {
namespace {

using Angle = EvaluationAngles::Angle;
using Complex = std::complex<DoubleDouble>;

constexpr int kHighest = 2;                                // multiple of one evaluation angle
constexpr int kHighestDegree = 4;                          // sum of multiples
constexpr double kTurnCost = 4 * operation(Op::mul).cost;  // that a degree takes
constexpr double kPairCost = operation(Op::sin).cost + operation(Op::cos).cost;

Angle canonical(Angle angle) {
  const auto first = std::find_if(angle.begin(), angle.end(), [](int a) { return a != 0; });
  if (first != angle.end() && *first < 0)
    for (auto& a : angle) a = static_cast<std::int16_t>(-a);
  return angle;
}

std::set<Angle> harmonics_of(const HarmonicEnergy& energy) {
  std::set<Angle> harmonics;
  const auto take = [&](const HarmonicSum& sum) {
    for (const auto& [key, term] : sum.terms()) harmonics.insert(canonical(key.angle));
  };
  for (const auto& row : energy.M)
    for (const auto& element : row) take(element);
  take(energy.potential);
  harmonics.erase(Angle{});
  return harmonics;
}

// The harmonics themselves, and their halves.
std::vector<Angle> candidates_of(const std::set<Angle>& harmonics) {
  std::set<Angle> candidates = harmonics;
  for (const Angle& angle : harmonics) {
    if (std::any_of(angle.begin(), angle.end(), [](int a) { return a % 2 != 0; })) continue;
    Angle half{};
    for (std::size_t i = 0; i < angle.size(); ++i) half[i] = static_cast<std::int16_t>(angle[i] / 2);
    candidates.insert(half);
  }
  std::vector<Angle> result(candidates.begin(), candidates.end());
  const auto length = [](const Angle& a) {
    int sum = 0;
    for (int x : a) sum += std::abs(x);
    return sum;
  };
  std::stable_sort(result.begin(), result.end(),
                   [&](const Angle& x, const Angle& y) { return length(x) < length(y); });
  if (result.size() > 16) result.resize(16);
  return result;
}

// Every harmonic that `angles` give, with its combination of the lowest degree.
void combine(const std::vector<Angle>& angles, std::size_t at, Angle sum, std::vector<int>& multiple,
             int degree, std::map<Angle, std::pair<int, std::vector<int>>>& reached) {
  if (at == angles.size()) {
    auto [found, fresh] = reached.try_emplace(sum, degree, multiple);
    if (!fresh && degree < found->second.first) found->second = {degree, multiple};
    return;
  }
  for (int k = -kHighest; k <= kHighest; ++k) {
    if (degree + std::abs(k) > kHighestDegree) continue;
    Angle next = sum;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = static_cast<std::int16_t>(next[i] + k * angles[at][i]);
    multiple[at] = k;
    combine(angles, at + 1, next, multiple, degree + std::abs(k), reached);
  }
  multiple[at] = 0;
}

struct Choice {
  double cost = std::numeric_limits<double>::infinity();
  EvaluationAngles made;
};

void consider(const std::vector<Angle>& angles, const std::set<Angle>& harmonics, Choice& best) {
  std::map<Angle, std::pair<int, std::vector<int>>> reached;
  std::vector<int> multiple(angles.size(), 0);
  combine(angles, 0, Angle{}, multiple, 0, reached);
  double cost = kPairCost * static_cast<double>(angles.size());
  EvaluationAngles made;
  made.angles = angles;
  for (const Angle& harmonic : harmonics) {
    const auto found = reached.find(harmonic);
    if (found == reached.end()) return;
    cost += kTurnCost * (found->second.first - 1);
    made.combinations[harmonic] = found->second.second;
  }
  if (cost < best.cost) best = {cost, std::move(made)};
}

void choose(const std::vector<Angle>& candidates, std::size_t from, std::size_t count,
            std::vector<Angle>& taken, const std::set<Angle>& harmonics, Choice& best) {
  if (taken.size() == count) return consider(taken, harmonics, best);
  for (std::size_t i = from; i < candidates.size(); ++i) {
    taken.push_back(candidates[i]);
    choose(candidates, i + 1, count, taken, harmonics, best);
    taken.pop_back();
  }
}

std::size_t rank_of(const std::set<Angle>& harmonics) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(harmonics.size()), kMostBaseAngles);
  Eigen::Index i = 0;
  for (const Angle& angle : harmonics) {
    for (Eigen::Index j = 0; j < kMostBaseAngles; ++j) rows(i, j) = angle[static_cast<std::size_t>(j)];
    ++i;
  }
  return static_cast<std::size_t>(singular_values(rows).rank());
}

// Phases that make a term of the angle, or of its double, a pure cosine.
std::vector<DoubleDouble> phases_of(const Angle& angle, const HarmonicEnergy& energy) {
  std::vector<DoubleDouble> phases{0};
  const auto offer = [&](DoubleDouble phase) {
    const DoubleDouble quarter = kPi / 2;
    for (DoubleDouble known : phases)
      if (abs(remainder(phase - known, quarter)) < 1e-9) return;
    if (phases.size() < 5) phases.push_back(phase);
  };
  Angle twice{};
  for (std::size_t i = 0; i < angle.size(); ++i) twice[i] = static_cast<std::int16_t>(2 * angle[i]);
  const auto look = [&](const HarmonicSum& sum) {
    for (const auto& [key, term] : sum.terms()) {
      if (key.angle == angle) offer(std::arg(term.value));
      if (key.angle == twice) offer(std::arg(term.value) / 2);
    }
  };
  look(energy.potential);
  for (const auto& row : energy.M)
    for (const auto& element : row) look(element);
  return phases;
}

}  // namespace

std::optional<EvaluationAngles> evaluation_angles(const HarmonicEnergy& energy) {
  const std::set<Angle> harmonics = harmonics_of(energy);
  if (harmonics.empty()) return EvaluationAngles{};
  const std::vector<Angle> candidates = candidates_of(harmonics);
  const std::size_t rank = rank_of(harmonics);
  Choice best;
  for (std::size_t count = rank; count <= std::min<std::size_t>(rank + 1, 5); ++count) {
    std::vector<Angle> taken;
    choose(candidates, 0, count, taken, harmonics, best);
  }
  if (best.made.angles.empty()) return std::nullopt;
  for (const Angle& angle : best.made.angles) best.made.phases.push_back(phases_of(angle, energy));
  return best.made;
}

}  // namespace mixloop
