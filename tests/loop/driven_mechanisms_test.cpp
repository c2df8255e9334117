// SPDX-License-Identifier: MIT
// The SCARA and the palletiser: their plans against inverse kinematics by hand, their mass matrices against
// kinetic energies written down body by body, and gravity against potentials.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "dynamics/procedure/procedure.hpp"
#include "loop/review.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

using std::cos, std::sin;
constexpr double kTurn = 2 * std::numbers::pi, kG = 9.81;

using Four = std::array<double, 4>;

/// The matrix of a quadratic form: M_ij = T(e_i + e_j) - T(e_i) - T(e_j).
Matrix matrix_of(const std::function<double(const Four&)>& energy) {
  Matrix M(4, 4);
  const auto unit = [](std::size_t i) {
    Four rates{};
    rates[i] = 1;
    return rates;
  };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      Four both = unit(i);
      both[j] += 1;
      M(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          energy(both) - energy(unit(i)) - energy(unit(j));
    }
  return M;
}

/// Of x, y and what turns about the upright axis: 1/2 m (x'^2 + y'^2 + z'^2) + 1/2 I w^2.
double planar_energy(double m, double x_rate, double y_rate, double z_rate, double I, double w) {
  return m / 2 * (x_rate * x_rate + y_rate * y_rate + z_rate * z_rate) + I / 2 * w * w;
}

/// q1, q2, z (downward), q4 of the motors' positions or rates.
Four scara_joints(const Four& psi) {
  const double q4 = psi[3] / 10;
  return {psi[0] / 80, psi[1] / 50, 0.02 * (psi[2] - q4) / kTurn, q4};
}

double scara_energy(const Four& psi, const Four& rates) {
  const Four q = scara_joints(psi), w = scara_joints(rates);
  const double first = w[0], second = w[0] + w[1], third = second - w[3];  // the quill hangs upside down
  const double a = q[0], b = q[0] + q[1], upper = 0.225, fore = 0.175;
  const auto at = [&](double along_upper, double along_fore) {
    return std::array{-along_upper * sin(a) * first - along_fore * sin(b) * second,
                      along_upper * cos(a) * first + along_fore * cos(b) * second};
  };
  const auto arm = at(upper / 2, 0), fore_arm = at(upper, fore / 2), hand = at(upper, fore);
  return planar_energy(4, arm[0], arm[1], 0, 0.02, first) +
         planar_energy(3, fore_arm[0], fore_arm[1], 0, 0.012, second) +
         planar_energy(0.5, hand[0], hand[1], w[2], 5e-5, third) +
         planar_energy(2, hand[0], hand[1], w[2], 3e-3, third);
}

double scara_potential(const Four& psi) {
  const double z = scara_joints(psi)[2];
  return -kG * (0.5 * z + 2 * (z + 0.12));
}

/// turn, lift, swing, spin of the motors' positions or rates.
Four palletiser_joints(const Four& psi) { return {psi[0] / 120, psi[1] / 150, psi[2] / 150, psi[3] / 60}; }

/// A body of the palletiser's arms: out from the turret's axis, up from the shoulder, their slopes by lift
/// and swing, and how fast it turns in the arms' plane.
struct InPlane {
  double m, out, out_lift, out_swing, up, up_lift, up_swing;
  double I_plane, turns_lift, turns_swing;  // about the plane's normal
  double I_along, I_across, angle;  // about its own axes in the plane, the first at this angle from the level
};

std::vector<InPlane> palletiser_arms(double lift, double swing) {
  const double u = 0.8, f = 0.9, c = 0.25, l = 0.2, cl = cos(lift), sl = sin(lift), cs = cos(swing),
               ss = sin(swing);
  // Along the upper arm by a, along the forearm by b, from the shoulder, then out and up from there.
  const auto at = [&](double a, double b, double out, double up) {
    return InPlane{
        0, 0.2 + a * cl + b * cs + out, -a * sl, -b * ss, a * sl + b * ss + up, a * cl, b * cs, 0, 0, 0, 0, 0,
        0};
  };
  const auto body = [](InPlane p, double m, double I, double by_lift, double by_swing, double I_along,
                       double I_across, double angle) {
    p.m = m, p.I_plane = I, p.turns_lift = by_lift, p.turns_swing = by_swing;
    p.I_along = I_along, p.I_across = I_across, p.angle = angle;
    return p;
  };
  const double rod = 3 * u * u / 12, long_rod = 3 * f * f / 12;
  return {body(at(u / 2, 0, 0, 0), 30, 30 * u * u / 12, 1, 0, 0.1, 30 * u * u / 12, lift),
          body(at(u, 0.35, 0, 0), 18, 1.6, 0, 1, 0.06, 1.6, swing),
          body(at(u / 2, -c, 0, 0), 3, rod, 1, 0, 0, rod, lift),  // parallel to the upper arm, from the crank
          body(at(u / 2, 0, 0, l), 3, rod, 1, 0, 0, rod, lift),   // from over the shoulder
          body(at(u, f / 2, 0, l), 3, long_rod, 0, 1, 0, long_rod, swing),
          body(at(u, 0, 0, l / 3), 2, 0.02, 0, 0, 0.01, 0.01, 0)};
}

double palletiser_energy(const Four& psi, const Four& rates) {
  const Four q = palletiser_joints(psi), w = palletiser_joints(rates);
  double energy = 4.0 / 2 * w[0] * w[0];
  for (const InPlane& b : palletiser_arms(q[1], q[2])) {
    const double out = b.out_lift * w[1] + b.out_swing * w[2], up = b.up_lift * w[1] + b.up_swing * w[2];
    const double upright = b.I_along * sin(b.angle) * sin(b.angle) + b.I_across * cos(b.angle) * cos(b.angle);
    energy +=
        planar_energy(b.m, out, b.out * w[0], up, b.I_plane, b.turns_lift * w[1] + b.turns_swing * w[2]) +
        upright / 2 * w[0] * w[0];
  }
  const double out = 0.35 + 0.8 * cos(q[1]) + 0.9 * cos(q[2]);
  const double out_rate = -0.8 * sin(q[1]) * w[1] - 0.9 * sin(q[2]) * w[2];
  const double up_rate = 0.8 * cos(q[1]) * w[1] + 0.9 * cos(q[2]) * w[2];
  return energy + planar_energy(8 + 25, out_rate, out * w[0], up_rate, 0.12 + 0.5, w[0] + w[3]);
}

double palletiser_potential(const Four& psi) {
  const Four q = palletiser_joints(psi);
  double potential = (8 + 25) * (0.8 * sin(q[1]) + 0.9 * sin(q[2]));
  for (const InPlane& b : palletiser_arms(q[1], q[2])) potential += b.m * b.up;
  return kG * potential;
}

/// M and, at rest, h of the scene against energy and potential by hand, at poses about home.
void expect_equations(const std::string& scene, double (*energy)(const Four&, const Four&),
                      double (*potential)(const Four&), const Four& spread) {
  const auto shared = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/" + scene + ".yaml", {}));
  const auto model = make_model<double>(shared, shared->default_parameters());
  Workspace<double> ws(model);
  const Four rest{};
  for (int k = 0; k < 5; ++k) {
    Four psi;
    for (std::size_t i = 0; i < 4; ++i)
      psi[i] = shared->home[i] + spread[i] * sin(1.0 + 2.3 * k * static_cast<double>(i + 1));
    const Matrix M = matrix_of([&](const Four& rates) { return energy(psi, rates); });
    EXPECT_LT((mass_matrix<double>(model, psi, 0.0, ws) - M).cwiseAbs().maxCoeff(),
              1e-14 * M.cwiseAbs().maxCoeff())
        << k;
    const Vector h = bias<double>(model, psi, rest, 0.0, ws);
    for (std::size_t i = 0; i < 4; ++i) {
      const double d = 0.01 * spread[i];
      const auto away = [&](double by) {
        Four moved = psi;
        moved[i] += by;
        return potential(moved);
      };
      // Differences of fourth order, of a sine of about 0.01: their error is (0.01)^4 / 30 of it.
      const double slope = (8 * (away(d) - away(-d)) - (away(2 * d) - away(-2 * d))) / (12 * d);
      EXPECT_NEAR(h[static_cast<Eigen::Index>(i)], slope, 1e-8 * h.cwiseAbs().maxCoeff()) << k << " " << i;
    }
  }
}

TEST(Scara, HasTheMassMatrixOfItsKineticEnergy) {
  expect_equations("scara", scara_energy, scara_potential, {80, 50, 6, 10});
}

TEST(Palletiser, HasTheMassMatrixOfItsKineticEnergy) {
  expect_equations("palletiser", palletiser_energy, palletiser_potential, {120, 40, 40, 60});
}

// Elbow bent to the left, as at home; the quill's turn counts from home, about the axis upward.
TEST(Scara, IsPlannedAsByHand) {
  const Experiment experiment = shipped_experiment("scara_pick_and_place");
  const Plan plan = make_plan(experiment);
  const double upper = 0.225, fore = 0.175, at_home = (-20 + 70) * kTurn / 360;
  for (std::int64_t k = 0; k <= plan.ticks(); k += 10) {
    const Reference now = plan.at(k);
    const double x = now.position[0], y = now.position[1], z = now.position[2];
    const double cosine = (x * x + y * y - upper * upper - fore * fore) / (2 * upper * fore);
    const double q2 = std::acos(cosine),
                 q1 = std::atan2(y, x) - std::atan2(fore * sin(q2), upper + fore * cos(q2));
    EXPECT_NEAR(now.psi[0], 80 * q1, 1e-10) << k;
    EXPECT_NEAR(now.psi[1], 50 * q2, 1e-10) << k;
    const double q4 = now.psi[3] / 10;
    EXPECT_NEAR(0.35 - 0.1 - 0.02 * (now.psi[2] - q4) / kTurn, z, 1e-13) << k;
    if (k <= 100) {
      EXPECT_NEAR(q1 + q2 - q4, at_home, 1e-12) << k;
    } else if (k >= 400 && k <= 550) {
      EXPECT_NEAR(q1 + q2 - q4, at_home + kTurn / 4, 1e-12) << k;
    }
  }
}

TEST(Palletiser, IsPlannedAsByHand) {
  const Experiment experiment = shipped_experiment("palletiser_stacks");
  const Plan plan = make_plan(experiment);
  const double u = 0.8, f = 0.9;
  for (std::int64_t k = 0; k <= plan.ticks(); k += 10) {
    const Reference now = plan.at(k);
    const Four q = palletiser_joints({now.psi[0], now.psi[1], now.psi[2], now.psi[3]});
    const double out = std::hypot(now.position[0], now.position[1]) - 0.35, up = now.position[2] - 0.7 + 0.15;
    // The triangle of upper arm and forearm, elbow up.
    const double D = std::hypot(out, up), level = std::atan2(up, out);
    EXPECT_NEAR(q[1], level + std::acos((D * D + u * u - f * f) / (2 * D * u)), 1e-12) << k;
    EXPECT_NEAR(q[2], level - std::acos((D * D + f * f - u * u) / (2 * D * f)), 1e-12) << k;
    EXPECT_NEAR(q[0], std::atan2(now.position[1], now.position[0]), 1e-12) << k;
    if (k <= 500 || k >= 1500) {
      EXPECT_NEAR(q[0] + q[3], k <= 500 ? 0 : kTurn / 4, 1e-12) << k;
    }
  }
}

// Nothing of the closures is left: as many operations as with the formulas that they come down to.
TEST(Palletiser, HasTheProgramOfItsFormulas) {
  const auto shared = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/palletiser.yaml", {}));
  EXPECT_FALSE(shared->is_closed());
  EXPECT_EQ(shared->linear.size(), 6U);
}

}  // namespace
}  // namespace mixloop
