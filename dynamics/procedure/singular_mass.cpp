// SPDX-License-Identifier: MIT
#include "dynamics/procedure/singular_mass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "dynamics/procedure/decompositions.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"

namespace mixloop {
namespace {

constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
/// Of what a diagonal element could be: it is a sum of squares of levers, each of which rounds.
constexpr double kNothing = 1e6 * kRoundOff * kRoundOff;
constexpr int kPosesAbout = 3;

/// No lever is longer.
double longest_lever(const Model<double>& model, const Workspace<double>& ws) {
  double length = 0, farthest = 0;
  for (const auto& link : model.links)
    length += std::abs(link.a) + std::abs(link.s) +
              (link.prismatic && link.coordinate >= 0 ? std::abs(link.scale * ws.q[link.coordinate]) : 0);
  for (const auto& body : model.bodies) farthest = std::max(farthest, body.center_of_mass.norm());
  return length + farthest;
}

/// What the diagonal elements could be at most, with every mass at the end of the longest lever.
Vector most_inertia(const Model<double>& model, const Workspace<double>& ws) {
  const double lever = longest_lever(model, ws);
  std::vector<bool> length(static_cast<std::size_t>(model.m()), false);
  for (const auto& link : model.links)
    if (link.coordinate >= 0 && link.prismatic) length[static_cast<std::size_t>(link.coordinate)] = true;
  Vector most = Vector::Zero(model.n());
  for (const auto& body : model.bodies)
    for (const int j : model.path(body.frame)) {
      const double inertia =
          length[static_cast<std::size_t>(j)] ? body.mass : body.mass * lever * lever + body.inertia.trace();
      most += inertia * ws.C.row(j).transpose().cwiseAbs2();
    }
  return most;
}

/// A motion that no inertia resists.
struct FreeMotion {
  Vector psid;        ///< n
  bool each = false;  ///< nor that of each of its coordinates alone
};

std::optional<FreeMotion> free_motion(const Model<double>& model, const Workspace<double>& ws) {
  const Vector most = most_inertia(model, ws);
  Vector motion = Vector::Zero(model.n());
  for (Eigen::Index i = 0; i < motion.size(); ++i)
    if (!(ws.M(i, i) > kNothing * most[i])) motion[i] = 1;
  if (motion.any()) return FreeMotion{motion, true};
  const Vector scale = ws.M.diagonal().cwiseSqrt().cwiseInverse();
  const SingularValues found = singular_values(scale.asDiagonal() * ws.M * scale.asDiagonal());
  // Of a symmetric matrix these are its eigenvalues' sizes; left and right vectors of a negative one are
  // opposite.
  const Vector values = found.s.cwiseProduct(found.U.cwiseProduct(found.V).colwise().sum().transpose());
  Eigen::Index least = 0;
  if (values.minCoeff(&least) > 8 * static_cast<double>(model.n()) * kRoundOff) return std::nullopt;
  return FreeMotion{scale.cwiseProduct(found.V.col(least)), false};
}

std::string description(const Model<double>& model, const Workspace<double>& ws, const FreeMotion& motion) {
  const Scene& scene = *model.scene;
  std::vector<std::string> coordinates, bodies;
  bool driven = true, free = true;
  const Vector share = motion.psid.cwiseAbs().cwiseProduct(ws.M.diagonal().cwiseSqrt());
  for (Eigen::Index i = 0; i < model.n(); ++i) {
    if (motion.each ? motion.psid[i] == 0 : share[i] < 0.1 * share.maxCoeff()) continue;
    const auto& independent = scene.independent[static_cast<std::size_t>(i)];
    coordinates.push_back(in_quotes(independent.name));
    (independent.driven ? free : driven) = false;
  }
  const Vector moved = ws.C * motion.psid;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const auto& path = model.path(model.bodies[b].frame);
    if (std::any_of(path.begin(), path.end(), [&](int j) { return moved[j] != 0; }))
      bodies.push_back(in_quotes(scene.bodies[b].name));
  }
  const bool several = coordinates.size() > 1;
  const std::string who = fmt::format("{}{} {}",
                                      driven ? "motor"
                                      : free ? "free coordinate"
                                             : "coordinate",
                                      several ? "s" : "", enumerated(coordinates));
  if (!motion.each) return who + " can move together without any inertia against it";
  if (bodies.empty())
    return fmt::format("no body hangs on {}; expected one that it moves, or the scene without it", who);
  return fmt::format(
      "{} {} no inertia: of what moves so, {} {} the mass on the axis and no moment of inertia about it; "
      "expected an inertia there",
      who, several ? "move" : "moves", enumerated(bodies), bodies.size() > 1 ? "have" : "has");
}

}  // namespace

std::optional<std::string> why_mass_is_singular(const Model<double>& model, std::span<const double> psi,
                                                double t) {
  Workspace<double> ws(model);
  mass_matrix<double>(model, psi, t, ws);
  if (!ws.M.allFinite()) return std::nullopt;  // another matter
  const auto motion = free_motion(model, ws);
  if (!motion) return std::nullopt;
  return description(model, ws, *motion);
}

void require_inertia(const std::shared_ptr<const Scene>& scene, const std::vector<double>& parameters) {
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  std::vector<double> psi = scene->home;
  const auto at_home = why_mass_is_singular(model, psi, 0);
  if (!at_home) return;
  std::mt19937_64 random(1);
  Workspace<double> ws(model);
  coordinates<double>(model, psi, 0.0, ws);
  const double length = std::max(longest_lever(model, ws), 1e-3);
  for (int pose = 0; pose < kPosesAbout; ++pose) {
    for (std::size_t i = 0; i < psi.size(); ++i)
      psi[i] = scene->home[i] + (scene->independent[i].linear ? length : 1) *
                                    (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    mass_matrix<double>(model, psi, 0.0, ws);
    if (ws.M.allFinite() && !why_mass_is_singular(model, psi, 0)) return;
  }
  throw InputError("singular_mass",
                   scene->bodies.empty() ? scene->transforms.front().place : scene->bodies.front().place,
                   "the mass matrix is singular at every pose: " + *at_home);
}

}  // namespace mixloop
