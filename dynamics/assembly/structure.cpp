// SPDX-License-Identifier: MIT
#include "dynamics/assembly/structure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/assembly/seeded.hpp"
#include "dynamics/assembly/settle.hpp"
#include "dynamics/procedure/decompositions.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

constexpr int kPoses = 3;
constexpr double kNoSlope = 1e-10;  // of a slope, of the largest in its row

std::string name_of(const Closing& closing, int unknown) {
  return "'" + closing.scene().coordinates[static_cast<std::size_t>(closing.coordinate(unknown))].name + "'";
}

std::vector<std::string> loose(const Closing& closing, const Matrix& slopes) {
  const auto values = singular_values(product(slopes.transpose(), slopes));
  std::vector<std::string> names;
  for (int i = 0; i < closing.unknowns(); ++i) {
    double part = 0;
    for (Eigen::Index k = 0; k < values.s.size(); ++k)
      if (values.s[k] <= 1e-18 * values.s[0]) part = std::max(part, std::abs(values.V(i, k)));
    if (part > 1e-6) names.push_back(name_of(closing, i));
  }
  return names;
}

/// Which unknowns each row has anything to do with.
class Incidence {
 public:
  Incidence(const std::vector<Matrix>& slopes, std::vector<int> rows, int unknowns)
      : rows_(std::move(rows)), unknowns_(unknowns) {
    for (int row : rows_) {
      auto& mine = of_.emplace_back();
      for (int u = 0; u < unknowns; ++u)
        if (std::any_of(slopes.begin(), slopes.end(), [&](const Matrix& s) {
              return std::abs(s(row, u)) > kNoSlope * s.row(row).cwiseAbs().maxCoeff();
            }))
          mine.push_back(u);
    }
  }

  /// Strongly connected blocks (Tarjan) of the unknowns, matched with a row each.
  std::vector<Closing::Part> blocks() {
    row_of_.assign(static_cast<std::size_t>(unknowns_), -1);
    for (std::size_t r = 0; r < of_.size(); ++r) {
      std::vector<bool> seen(static_cast<std::size_t>(unknowns_), false);
      match(static_cast<int>(r), seen);
    }
    index_.assign(static_cast<std::size_t>(unknowns_), -1);
    low_ = index_;
    for (int u = 0; u < unknowns_; ++u)
      if (index_[static_cast<std::size_t>(u)] < 0) visit(u);
    for (auto& block : blocks_) {
      std::sort(block.unknowns.begin(), block.unknowns.end());
      std::sort(block.rows.begin(), block.rows.end());
    }
    return blocks_;
  }

 private:
  bool match(int row, std::vector<bool>& seen) {
    for (int u : of_[static_cast<std::size_t>(row)]) {
      const auto at = static_cast<std::size_t>(u);
      if (seen[at]) continue;
      seen[at] = true;
      if (row_of_[at] >= 0 && !match(row_of_[at], seen)) continue;
      row_of_[at] = row;
      return true;
    }
    return false;
  }

  void visit(int u) {
    const auto at = static_cast<std::size_t>(u);
    index_[at] = low_[at] = next_++;
    stack_.push_back(u);
    for (int v : of_[static_cast<std::size_t>(row_of_[at])]) {
      const auto to = static_cast<std::size_t>(v);
      if (index_[to] < 0) {
        visit(v);
        low_[at] = std::min(low_[at], low_[to]);
      } else if (std::find(stack_.begin(), stack_.end(), v) != stack_.end()) {
        low_[at] = std::min(low_[at], index_[to]);
      }
    }
    if (low_[at] != index_[at]) return;
    Closing::Part block;
    for (int v = -1; v != u;) {
      v = stack_.back();
      stack_.pop_back();
      block.unknowns.push_back(v);
      block.rows.push_back(rows_[static_cast<std::size_t>(row_of_[static_cast<std::size_t>(v)])]);
    }
    blocks_.push_back(std::move(block));
  }

  std::vector<int> rows_;
  int unknowns_;
  std::vector<std::vector<int>> of_;
  std::vector<int> row_of_, index_, low_, stack_;
  std::vector<Closing::Part> blocks_;
  int next_ = 0;
};

/// The slopes beside closed poses: there a row depends on all that it is made of, though a closed one may
/// never show it (in a parallelogram one of the rows has no slope by the coupler's angle).
std::vector<Matrix> open_slopes(Closing& closing, const Vector& x) {
  Seeded seeded(5);
  std::vector<Matrix> slopes;
  for (int i = 0; i < 2; ++i) {
    Vector open = x, psi = closing.home_psi();
    for (auto* values : {&open, &psi})
      for (auto& value : *values) value += 0.7 * seeded.draw();
    slopes.push_back(closing.slopes(closing.whole(), open, psi));
  }
  return slopes;
}

double largest(const Matrix& slopes) { return slopes.size() == 0 ? 0.0 : slopes.cwiseAbs().maxCoeff(); }

}  // namespace

std::vector<int> independent_rows(const Matrix& slopes) {
  std::vector<int> kept;
  Matrix basis(slopes.cols(), 0);
  const double most = largest(slopes);
  for (int i = 0; i < slopes.rows(); ++i) {
    Vector rest = slopes.row(i).transpose();
    const double length = rest.norm();
    if (!(length > kNoSlope * most)) continue;
    for (int twice = 0; twice < 2; ++twice) rest -= basis * (basis.transpose() * rest);
    if (rest.norm() <= 1e-9 * length) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.col(basis.cols() - 1) = rest.normalized();
    kept.push_back(i);
  }
  return kept;
}

std::vector<ClosedPose> poses_about(Closing& closing, const Vector& x, int count) {
  Seeded seeded(20);
  std::vector<ClosedPose> poses;
  const auto& scene = closing.scene();
  for (int tries = 0; tries < 8 * count && static_cast<int>(poses.size()) < count; ++tries) {
    const double reach = 0.4 / (1 << (tries / count));
    ClosedPose pose{x, closing.home_psi()};
    for (int i = 0; i < scene.n(); ++i)
      pose.psi[i] +=
          reach * seeded.draw() * (scene.independent[static_cast<std::size_t>(i)].linear ? scene.size : 1.0);
    if (settle(closing, closing.whole(), pose.x, pose.psi).closes) poses.push_back(std::move(pose));
  }
  return poses;
}

Structure structure_of(Closing& closing, const Vector& x) {
  const Closing::Part whole = closing.whole();
  std::vector<Matrix> slopes{closing.slopes(whole, x, closing.home_psi())};
  for (const auto& pose : poses_about(closing, x, kPoses))
    slopes.push_back(closing.slopes(whole, pose.x, pose.psi));
  std::size_t best = 0;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    if (independent_rows(slopes[i]).size() > independent_rows(slopes[best]).size()) best = i;
  const std::vector<int> kept = independent_rows(slopes[best]);
  const Place place = closing.scene().closures.front().place;
  if (static_cast<int>(kept.size()) < closing.unknowns())
    throw InputError(
        "underconstrained", place,
        fmt::format("the closures determine {} of {} coordinates without a formula; {} can move while the "
                    "motors stand. Expected more closures, or a formula, a motor or 'free' for what moves",
                    kept.size(), closing.unknowns(), joined(loose(closing, slopes[best]))));
  if (independent_rows(slopes.front()).size() < kept.size())
    throw InputError(
        "singular_home", place,
        fmt::format("at home the mechanism is in a singular pose: {} can move there while the motors stand, "
                    "elsewhere not. Expected another home",
                    joined(loose(closing, slopes.front()))));
  Structure structure;
  structure.blocks = Incidence(open_slopes(closing, x), kept, closing.unknowns()).blocks();
  for (int row = 0; row < closing.rows(); ++row) {
    const bool is_kept = std::find(kept.begin(), kept.end(), row) != kept.end();
    const bool says_nothing = std::all_of(slopes.begin(), slopes.end(), [&](const Matrix& s) {
      return largest(s.row(row)) <= kNoSlope * largest(s);
    });
    if (!is_kept && !says_nothing) structure.redundant.push_back(row);
  }
  return structure;
}

}  // namespace mixloop
