// SPDX-License-Identifier: MIT
#include "import/inertia.hpp"

#include <fmt/format.h>

#include "import/rotation.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

/// Published moments have three digits or so: what a sum of two misses by that is rounding.
constexpr double kRounding = 1e-3;

Eigen::Matrix3d tensor_of(const std::array<double, 6>& I) {
  Eigen::Matrix3d tensor;
  tensor << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return tensor;
}

void check_inertia(const Robot::Link& link, bool any, LeftBehind& left) {
  const auto& inertial = *link.inertial;
  if (inertial.mass < 0)
    throw InputError("negative_mass", inertial.place,
                     fmt::format("the link {} has a mass of {} kg; expected more than 0",
                                 in_quotes(link.name), inertial.mass));
  const Eigen::Matrix3d tensor = tensor_of(inertial.inertia);
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  const double size = tensor.cwiseAbs().maxCoeff();
  if (!moments.allFinite() || moments[0] < -1e-14 * size)
    throw InputError(
        "impossible_inertia", inertial.place,
        fmt::format(
            "the link {} has a principal moment of inertia of {:.6g} kg m^2 (is it given about another "
            "point than the centre of mass, or have the products the other sign?); expected none below 0",
            in_quotes(link.name), moments[0]));
  const double sum = moments[0] + moments[1];
  if (moments[2] <= sum * (1 + kRounding)) return;
  if (!any)
    throw InputError(
        "impossible_inertia", inertial.place,
        fmt::format(
            "the largest moment of inertia of the link {}, {:.6g} kg m^2, exceeds the sum of the two others, "
            "{:.6g}: no real mass is spread so; correct it, or take it as it is with --any-inertia",
            in_quotes(link.name), moments[2], sum));
  left.add("inertias that no real mass has, taken as they are, of the links", link.name, inertial.place);
}

/// Of each link, the mass of what moves with it: of all that fixed joints hold together.
std::vector<double> masses_together(const Robot& robot) {
  std::vector<std::size_t> together(robot.links.size(), 0);
  std::vector<double> masses(robot.links.size(), 0);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const auto& link = robot.links[i];
    const auto* joint = link.joint < 0 ? nullptr : &robot.joints[static_cast<std::size_t>(link.joint)];
    together[i] = joint == nullptr || joint->moves() ? i : together[static_cast<std::size_t>(joint->parent)];
    if (link.inertial) masses[together[i]] += link.inertial->mass;
  }
  return masses;
}

}  // namespace

Eigen::Matrix3d inertia_in_link(const Robot::Inertial& inertial) {
  const Eigen::Matrix3d I = tensor_of(inertial.inertia);
  if (!inertial.origin.is_turned()) return I;
  const Eigen::Matrix3d R = rotation_of(inertial.origin.rpy);
  const Eigen::Matrix3d turned = R * I * R.transpose();
  return (turned + turned.transpose()) / 2;
}

void check_inertias(const Robot& robot, bool any, LeftBehind& left) {
  const std::vector<bool> moved = moved_links(robot);
  const std::vector<double> masses = masses_together(robot);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const auto& link = robot.links[i];
    if (link.inertial && moved[i]) check_inertia(link, any, left);
    if (link.joint < 0) continue;
    const auto& joint = robot.joints[static_cast<std::size_t>(link.joint)];
    if (joint.moves() && masses[i] <= 0)
      throw InputError(
          "massless_link", link.inertial ? link.inertial->place : link.place,
          fmt::format(
              "the link {}, which the joint {} moves, has no mass, nor has what is fixed to it; expected "
              "<inertial> with a mass above 0, or a joint of the type fixed",
              in_quotes(link.name), in_quotes(joint.name)));
  }
}

std::vector<bool> moved_links(const Robot& robot) {
  std::vector<bool> moved(robot.links.size(), false);
  for (const auto& joint : robot.joints)
    moved[static_cast<std::size_t>(joint.child)] =
        joint.moves() || moved[static_cast<std::size_t>(joint.parent)];
  return moved;
}

}  // namespace mixloop
