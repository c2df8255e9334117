// SPDX-License-Identifier: MIT
// The hand-tuned evaluations as engines. Built twice, with and without contraction: see CMakeLists.txt.
#include <math.h>

#include "bench/engine.hpp"
#include "bench/hand_tuned.hpp"
#include "bench/hand_tuned_simd.hpp"
#include "bench/hand_tuned_sincos.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop::bench {
namespace {

using namespace hand_tuned;

constexpr Lumped kFolded = lump(kPayload, kGravity);

constexpr auto kLibrarySincos = [](double x, double* sine, double* cosine) { ::sincos(x, sine, cosine); };
constexpr auto kInlinedSincos = [](double x, double* sine, double* cosine) {
  paired_sincos(x, sine, cosine);
};

constexpr auto kThreeFromLibrary = [](const double* psi) { return three_pairs(psi, kLibrarySincos); };
constexpr auto kTwoFromLibrary = [](const double* psi) { return two_pairs(psi, kLibrarySincos); };
constexpr auto kThreeInlined = [](const double* psi) { return three_pairs(psi, kInlinedSincos); };
constexpr auto kTwoInlined = [](const double* psi) { return two_pairs(psi, kInlinedSincos); };
constexpr auto kThreeOfThePrograms = [](const double* psi) {
  const double x = 0.0234375 * psi[0], a = x - 0.0625 * psi[1], b = x - 0.0625 * psi[2];
  const double angles[3] = {a, b, (3.0 * a + kOffsetC) - 2.0 * b};
  double s[3], c[3];
  mixloop_functions::sincos_of(angles, s, c);
  return Angles<double>{s[0], c[0], s[1], c[1], s[2], c[2]};
};

/// `n` are the folded numbers or ones made at run time.
template <class Numbers, class Angles>
Engine engine(std::string name, Numbers n, Angles angles) {
  Engine made;
  made.name = std::move(name);
  made.forward = [=](const State& state, Triple& psidd) {
    forward_dynamics<double>(n, angles(state.psi.data()), state.psid.data(), state.tau.data(), psidd.data());
  };
  made.mass = [=](const State& state, MassMatrix& M) {
    mass_matrix<double>(n, angles(state.psi.data()), M.data());
  };
  made.mass_times = [=](const State& state, Triple& force) {
    mass_times<double>(n, angles(state.psi.data()), state.tau.data(), force.data());
  };
  made.forward_and_mass_times = [=](const State& state, Triple& psidd, Triple& force) {
    forward_dynamics_and_mass_times<double>(n, angles(state.psi.data()), state.psid.data(), state.tau.data(),
                                            state.tau.data(), psidd.data(), force.data());
  };
  return made;
}

/// Converts to the folded numbers: a stateless type, so that they stay constants in the code.
struct Folded {
  constexpr operator const Lumped&() const { return kFolded; }  // NOLINT(google-explicit-constructor)
};

Lumped unknown_payload() {
  volatile double payload = kPayload;  // unknown to the compiler
  return lump(payload, kGravity);
}

Engine vectors_inside() {
  Engine engine;
  engine.name = "vectors inside, one 4-lane sincos";
  engine.forward = [](const State& state, Triple& psidd) {
    paired_forward_dynamics(kFolded, state.psi.data(), state.psid.data(), state.tau.data(), psidd.data());
  };
  engine.mass = [](const State& state, MassMatrix& M) {
    paired_mass_matrix(kFolded, state.psi.data(), M.data());
  };
  return engine;
}

template <int lanes>
struct LaneState {
  Lanes<lanes> psi[3], psid[3], tau[3], psidd[3];
};

/// The loads and stores between an array of states and lanes belong to the caller's layout and aren't timed.
template <int lanes>
Engine in_lanes(std::string name) {
  using Block = LaneState<lanes>;
  Engine engine;
  engine.name = std::move(name);
  engine.forward_all = [blocks = std::vector<Block>(), known = static_cast<const State*>(nullptr)](
                           const std::vector<State>& states, std::vector<Triple>& psidd) mutable {
    if (known != states.data()) {
      known = states.data();
      blocks.assign(states.size() / lanes, Block{});
      for (std::size_t i = 0; i < states.size(); ++i)
        for (int k = 0; k < 3; ++k) {
          blocks[i / lanes].psi[k][i % lanes] = states[i].psi[k];
          blocks[i / lanes].psid[k][i % lanes] = states[i].psid[k];
          blocks[i / lanes].tau[k][i % lanes] = states[i].tau[k];
        }
    }
    for (Block& block : blocks)
      forward_dynamics(kFolded, three_pairs(block.psi, lane_sincos<lanes>), block.psid, block.tau,
                       block.psidd);
    if (psidd.empty()) return;  // only timed
    for (std::size_t i = 0; i < states.size(); ++i)
      for (int k = 0; k < 3; ++k) psidd[i][k] = blocks[i / lanes].psidd[k][i % lanes];
  };
  return engine;
}

}  // namespace

#ifdef MIXLOOP_FUSED
void add_hand_tuned_contracted(Engines& engines) {
  const std::string family = "hand-tuned (fused), ";
#else
void add_hand_tuned(Engines& engines) {
  const std::string family = "hand-tuned, ";
#endif
  const auto add = [&](Engine engine) {
    engine.name = family + engine.name;
    engines.push_back(std::move(engine));
  };
  add(engine("3 C library sincos", Folded{}, kThreeFromLibrary));
  add(engine("2 C library sincos", Folded{}, kTwoFromLibrary));
  add(engine("3 inlined sincos", Folded{}, kThreeInlined));
  add(engine("2 inlined sincos", Folded{}, kTwoInlined));
  add(engine("the programs' sincos, three at once", Folded{}, kThreeOfThePrograms));
  add(engine("3 inlined sincos, payload a parameter", unknown_payload(), kThreeInlined));
  add(vectors_inside());
  add(in_lanes<4>("4 lanes"));
  add(in_lanes<8>("8 lanes"));
}

}  // namespace mixloop::bench
