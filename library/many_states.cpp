// SPDX-License-Identifier: MIT
#include "library/many_states.hpp"

#include <algorithm>

#include "dynamics/program/trace.hpp"

namespace mixloop::inside {

ManyStates::ManyStates(const Equations& equations, Purpose purpose, std::span<const double> parameters) {
  const auto scene = std::make_shared<const Scene>(equations.scene());
  // Each state would need a start of its own for its closures: one after the other they find it.
  if (!scene->started.empty()) return;
  std::string complaint;
  code_ = LaneCode::load(
      std::string(name_of(purpose)) + "\n" + scene->canonical, [&] { return trace(scene, purpose).program; },
      complaint);
  if (!code_) return;
  set_parameters(parameters);
  const auto rows = [this](std::size_t numbers) {
    return Rows{numbers, std::vector<double>(numbers * static_cast<std::size_t>(code_->width()))};
  };
  const int n = scene->n(), n_u = scene->n_u();
  psi_ = psid_ = rows(static_cast<std::size_t>(n));
  input_ = rows(static_cast<std::size_t>(signature(purpose).input_size(n, n_u)));
  t_ = rows(1);
  out_ = rows(output_size(purpose, n, n_u));
}

void ManyStates::set_parameters(std::span<const double> parameters) {
  if (code_) constants_ = code_->constants(parameters);
}

/// Lanes past the last state repeat it.
void ManyStates::Rows::take(std::span<const double> all, std::size_t first, std::size_t states,
                            std::size_t width) {
  if (all.empty()) return;
  for (std::size_t lane = 0; lane < width; ++lane)
    for (std::size_t i = 0; i < numbers; ++i)
      lanes[i * width + lane] = all[(first + std::min(lane, states - 1)) * numbers + i];
}

void ManyStates::Rows::put(std::span<double> all, std::size_t first, std::size_t states,
                           std::size_t width) const {
  for (std::size_t lane = 0; lane < states; ++lane)
    for (std::size_t i = 0; i < numbers; ++i) all[(first + lane) * numbers + i] = lanes[i * width + lane];
}

Status ManyStates::evaluate(const LaneArguments& at, std::span<double> out) {
  if (at.psid.empty()) std::ranges::fill(psid_.lanes, 0.0);
  if (at.input.empty()) std::ranges::fill(input_.lanes, 0.0);
  const auto width = static_cast<std::size_t>(code_->width());
  for (std::size_t first = 0; first < at.t.size(); first += width) {
    const std::size_t states = std::min(width, at.t.size() - first);
    psi_.take(at.psi, first, states, width);
    psid_.take(at.psid, first, states, width);
    input_.take(at.input, first, states, width);
    t_.take(at.t, first, states, width);
    code_->run({psi_.lanes, psid_.lanes, input_.lanes, t_.lanes}, constants_, out_.lanes.data());
    out_.put(out, first, states, width);
  }
  return status_of(out);
}

}  // namespace mixloop::inside
