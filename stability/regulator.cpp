// SPDX-License-Identifier: MIT
#include "stability/regulator.hpp"

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {
namespace {

constexpr int kMostDoublings = 60;  // each squares the closed loop's transition
constexpr double kSettled = 1e-14;  // of the largest element

}  // namespace

// X = Q + Phi^T X (I + G X)^-1 Phi, G = Gamma R^-1 Gamma^T: X is H's limit of
//   A <- A (I + G H)^-1 A
//   G <- G + A G (I + H G)^-1 A^T
//   H <- H + A^T H (I + G H)^-1 A
// from A = Phi, H = Q.
std::optional<Matrix> regulator_gain(const Held& held, const Vector& state, const Vector& torque) {
  const Matrix I = Matrix::Identity(state.size(), state.size());
  Matrix A = held.Phi, H = state.asDiagonal();
  Matrix G = product(held.Gamma * torque.cwiseInverse().asDiagonal(), held.Gamma.transpose());
  bool settled = false;
  for (int k = 0; k < kMostDoublings && !settled; ++k) {
    const Matrix factor = I + product(G, H);
    const Matrix W = solved(factor, A);  // (I + G H)^-1 A
    const Matrix V = solved(factor, G);  // (I + G H)^-1 G = G (I + H G)^-1
    const Matrix added = product(A.transpose(), product(H, W));
    G += product(product(A, V), A.transpose());
    A = product(A, W);
    H += (added + added.transpose()) / 2;
    if (!H.allFinite() || !G.allFinite()) return std::nullopt;
    settled = added.cwiseAbs().maxCoeff() <= kSettled * H.cwiseAbs().maxCoeff();
  }
  if (!settled) return std::nullopt;
  const Matrix R = torque.asDiagonal();
  const Matrix weighted = product(held.Gamma.transpose(), H);
  Matrix K = solved(R + product(weighted, held.Gamma), product(weighted, held.Phi));
  if (!K.allFinite() || !(eigenvalues(held.Phi - product(held.Gamma, K)).cwiseAbs().maxCoeff() < 1))
    return std::nullopt;
  return K;
}

}  // namespace mixloop
