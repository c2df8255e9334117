// SPDX-License-Identifier: MIT
// The project's own evaluations of scenes/mixed_loop_robot.yaml.
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "bench/engine.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/program/lanes.hpp"
#include "dynamics/program/shared_object.hpp"
#include "dynamics/program/source.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/document.hpp"

namespace mixloop::bench {
namespace {

using ScenePtr = std::shared_ptr<const Scene>;
using Evaluate = void (*)(const double*, const double*, const double*, double, const double*, double*);
using SetUp = void (*)(const double*, double*);

/// The scene with its payload a constant: folded into the program.
ScenePtr with_payload_folded() {
  std::ifstream file(MIXLOOP_SCENES "/mixed_loop_robot.yaml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string said = "parameters:\n  payload: 5 kg\n", constants = "constants:\n";
  const auto at = text.find(said);
  if (at == std::string::npos) throw std::runtime_error("the scene's payload is no longer where it was");
  text.erase(at, said.size());
  text.insert(text.find(constants) + constants.size(), "  payload: 5 kg\n");
  return std::make_shared<const Scene>(load_scene(parse_document(text, "mixed_loop_robot.yaml")));
}

/// What a user's firmware would call: the emitted function itself.
struct Emitted {
  SharedObject library;
  Evaluate evaluate = nullptr;
  std::vector<double> k;
};

std::shared_ptr<Emitted> emitted(const ScenePtr& scene, Purpose purpose, Trigonometry trigonometry) {
  auto made = std::make_shared<Emitted>();
  SourceStyle style;
  style.trigonometry = trigonometry;
  std::string complaint;
  const std::string key = "bench " + std::string(name_of(purpose)) +
                          std::to_string(static_cast<int>(trigonometry)) + scene->canonical;
  made->library = SharedObject::cached(
      key, [&] { return source_head(style) + source_of(trace(scene, purpose).program, style); }, complaint);
  if (!made->library) throw std::runtime_error(complaint);
  made->evaluate = reinterpret_cast<Evaluate>(made->library.symbol(style.prefix));
  made->k.resize(
      static_cast<std::size_t>(*static_cast<const int*>(made->library.symbol(style.prefix + "_constants"))));
  const std::vector<double> parameters = scene->default_parameters();
  reinterpret_cast<SetUp>(made->library.symbol(style.prefix + "_set_up"))(parameters.data(), made->k.data());
  return made;
}

Engine emitted_engine(std::string name, const ScenePtr& scene, Trigonometry trigonometry) {
  Engine engine;
  engine.name = std::move(name);
  const auto run = [&](Purpose purpose) {
    return [program = emitted(scene, purpose, trigonometry)](const double* psi, const double* psid,
                                                             const double* input, double* out) {
      program->evaluate(psi, psid, input, 0.0, program->k.data(), out);
    };
  };
  engine.forward = [forward = run(Purpose::forward_dynamics)](const State& state, Triple& psidd) {
    forward(state.psi.data(), state.psid.data(), state.tau.data(), psidd.data());
  };
  engine.whole_matrix = true;
  engine.mass = [mass = run(Purpose::mass_matrix)](const State& state, MassMatrix& M) {
    mass(state.psi.data(), nullptr, nullptr, M.data());
  };
  engine.mass_times = [times = run(Purpose::mass_times)](const State& state, Triple& force) {
    times(state.psi.data(), nullptr, state.tau.data(), force.data());
  };
  engine.forward_and_mass_times = [both = run(Purpose::dynamics_and_mass_times)](
                                      const State& state, Triple& psidd, Triple& force) {
    double in[6], out[6];
    for (std::size_t k = 0; k < 3; ++k) in[k] = in[k + 3] = state.tau[k];
    both(state.psi.data(), state.psid.data(), in, out);
    for (std::size_t k = 0; k < 3; ++k) psidd[k] = out[k], force[k] = out[k + 3];
  };
  return engine;
}

Engine through_equations(const ScenePtr& scene, Evaluation how) {
  const std::vector<double> parameters{kPayload};
  const auto equations = equations_of(scene, how,
                                      {Purpose::forward_dynamics, Purpose::mass_matrix, Purpose::mass_times,
                                       Purpose::dynamics_and_mass_times});
  const auto dynamics = std::make_shared<Equations::Workspace>(equations, parameters);
  Engine made;
  made.name = "mixloop, " + std::string(name_of(equations->evaluation()));
  if (how == Evaluation::machine_code) made.name += ", through Equations";
  made.forward = [dynamics](const State& state, Triple& psidd) {
    dynamics->evaluate(Purpose::forward_dynamics, {state.psi, state.psid, state.tau}, psidd);
  };
  made.whole_matrix = true;
  made.mass = [dynamics](const State& state, MassMatrix& M) {
    dynamics->evaluate(Purpose::mass_matrix, {.psi = state.psi}, M);
  };
  made.mass_times = [dynamics](const State& state, Triple& force) {
    dynamics->evaluate(Purpose::mass_times, {.psi = state.psi, .input = state.tau}, force);
  };
  made.forward_and_mass_times = [dynamics](const State& state, Triple& psidd, Triple& force) {
    std::array<double, 6> in, out;
    for (std::size_t k = 0; k < 3; ++k) in[k] = in[k + 3] = state.tau[k];
    dynamics->evaluate(Purpose::dynamics_and_mass_times, {state.psi, state.psid, in}, out);
    for (std::size_t k = 0; k < 3; ++k) psidd[k] = out[k], force[k] = out[k + 3];
  };
  return made;
}

/// The states in lanes belong to the caller's layout and aren't timed, as for the hand-tuned lanes.
Engine in_lanes(const ScenePtr& scene) {
  std::string complaint;
  const std::shared_ptr<LaneCode> code = LaneCode::load(
      "bench" + scene->canonical, [&] { return trace(scene, Purpose::forward_dynamics).program; }, complaint);
  if (!code) throw std::runtime_error(complaint);
  const std::vector<double> constants = code->constants(scene->default_parameters());
  const auto width = static_cast<std::size_t>(code->width());
  Engine engine;
  engine.name = "mixloop, machine code, " + std::to_string(width) + " lanes";
  engine.forward_all = [=, in = std::vector<double>(), out = std::vector<double>(),
                        known = static_cast<const State*>(nullptr)](const std::vector<State>& states,
                                                                    std::vector<Triple>& psidd) mutable {
    const std::size_t blocks = states.size() / width, size = 9 * width;
    if (known != states.data()) {
      known = states.data();
      in.assign(blocks * size, 0.0);
      out.assign(blocks * 3 * width, 0.0);
      for (std::size_t i = 0; i < states.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          double* block = &in[i / width * size + i % width];
          block[k * width] = states[i].psi[k];
          block[(3 + k) * width] = states[i].psid[k];
          block[(6 + k) * width] = states[i].tau[k];
        }
    }
    const double t[8] = {};
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto part = [&](std::size_t i) {
        return std::span(in).subspan(b * size + 3 * i * width, 3 * width);
      };
      code->run({part(0), part(1), part(2), t}, constants, &out[b * 3 * width]);
    }
    if (psidd.empty()) return;  // only timed
    for (std::size_t i = 0; i < states.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) psidd[i][k] = out[(i / width * 3 + k) * width + i % width];
  };
  return engine;
}

}  // namespace

void add_mixloop(Engines& engines) {
  const auto scene = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  const ScenePtr folded = with_payload_folded();
  engines.push_back(
      emitted_engine("mixloop, machine code, C library sincos", folded, Trigonometry::c_library));
  engines.push_back(emitted_engine("mixloop, machine code, C library sincos, payload a parameter", scene,
                                   Trigonometry::c_library));
  engines.push_back(emitted_engine("mixloop, machine code, inlined sincos", folded, Trigonometry::inlined));
  engines.push_back(emitted_engine("mixloop, machine code, inlined sincos, payload a parameter", scene,
                                   Trigonometry::inlined));
  engines.push_back(in_lanes(folded));
  for (const Evaluation how : {Evaluation::machine_code, Evaluation::interpreter, Evaluation::reference})
    engines.push_back(through_equations(scene, how));
}

}  // namespace mixloop::bench
