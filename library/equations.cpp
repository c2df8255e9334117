// SPDX-License-Identifier: MIT
#include "dynamics/equations.hpp"

#include <fmt/format.h>

#include "dynamics/program/firmware.hpp"
#include "library/inside.hpp"
#include "library/many_states.hpp"

namespace mixloop::v1 {
namespace {

// The enumerators of the interface are those of the rooms, in the same order.
constexpr auto inner(Purpose purpose) { return static_cast<mixloop::Purpose>(purpose); }
constexpr auto inner(Evaluation how) { return static_cast<mixloop::Evaluation>(how); }
constexpr auto outer(mixloop::Status status) { return static_cast<Status>(status); }
static_assert(kPurposes.size() == 9);
static_assert(inner(Purpose::forward_dynamics) == mixloop::Purpose::forward_dynamics &&
              inner(Purpose::mass_times) == mixloop::Purpose::mass_times &&
              inner(Purpose::mass_matrix) == mixloop::Purpose::mass_matrix &&
              inner(Purpose::bias) == mixloop::Purpose::bias &&
              inner(Purpose::inverse_dynamics) == mixloop::Purpose::inverse_dynamics &&
              inner(Purpose::end_effector) == mixloop::Purpose::end_effector &&
              inner(Purpose::energy) == mixloop::Purpose::energy &&
              inner(Purpose::linearisation) == mixloop::Purpose::linearisation &&
              inner(Purpose::dynamics_and_mass_times) == mixloop::Purpose::dynamics_and_mass_times);
static_assert(inner(Evaluation::reference) == mixloop::Evaluation::reference &&
              inner(Evaluation::interpreter) == mixloop::Evaluation::interpreter &&
              inner(Evaluation::machine_code) == mixloop::Evaluation::machine_code);
static_assert(detail::kStatuses.size() == 3 && outer(mixloop::Status::ok) == Status::ok &&
              outer(mixloop::Status::not_finite) == Status::not_finite);

std::vector<mixloop::Purpose> inner_all(const std::vector<Purpose>& purposes) {
  std::vector<mixloop::Purpose> result;
  for (const Purpose purpose : purposes) result.push_back(inner(purpose));
  return result;
}

std::vector<mixloop::Purpose> checked(const std::vector<Purpose>& purposes, Evaluation how) {
  for (const Purpose purpose : purposes)
    if (purpose == Purpose::linearisation && how == Evaluation::reference)
      throw Error("out_of_range", {},
                  "the reference knows no derivatives, which a linearisation takes; expected the interpreter "
                  "or machine code");
  return inner_all(purposes);
}

using Asked = std::array<bool, kPurposes.size()>;

void require_asked(const Asked& asked, Purpose purpose) {
  if (asked[static_cast<std::size_t>(purpose)]) return;
  throw Error("not_asked_for", {},
              fmt::format("{} was not among the purposes that these equations were made for; expected one of "
                          "them",
                          name_of(inner(purpose))));
}

std::size_t input_numbers(const mixloop::Scene& scene, Purpose purpose) {
  return static_cast<std::size_t>(signature(inner(purpose)).input_size(scene.n(), scene.n_u()));
}

}  // namespace

struct Equations::Content {
  Content(const std::shared_ptr<const mixloop::Scene>& scene, const std::vector<mixloop::Purpose>& purposes,
          Evaluation how)
      : equations(std::make_shared<const mixloop::Equations>(scene, inner(how), purposes,
                                                             mixloop::Equations::Options{})),
        parameters(scene->default_parameters()),
        workspace(equations, parameters),
        zeros(static_cast<std::size_t>(2 * scene->n()), 0.0) {
    for (const mixloop::Purpose purpose : purposes) asked[static_cast<std::size_t>(purpose)] = true;
  }

  std::shared_ptr<const mixloop::Equations> equations;
  std::vector<double> parameters;
  mixloop::Equations::Workspace workspace;
  std::vector<double> zeros;
  Asked asked{};
  std::array<std::optional<inside::ManyStates>, kPurposes.size()> many;
};

Equations::Equations(const Scene& scene, const std::vector<Purpose>& purposes, Evaluation how)
    : content_(inside::translated(
          [&] { return std::make_unique<Content>(Inside::of(scene), checked(purposes, how), how); })) {}
Equations::Equations(const Equations& other) : content_(std::make_unique<Content>(*other.content_)) {}
Equations::Equations(Equations&&) noexcept = default;
Equations& Equations::operator=(Equations other) noexcept {
  std::swap(content_, other.content_);
  return *this;
}
Equations::~Equations() = default;

Evaluation Equations::evaluation() const {
  return static_cast<Evaluation>(content_->equations->evaluation());
}
const std::string& Equations::complaint() const { return content_->equations->complaint(); }

void Equations::set_parameters(std::span<const double> values) {
  inside::require_size("the list of parameters", values.size(), content_->parameters.size());
  content_->parameters.assign(values.begin(), values.end());
  content_->workspace.set_parameters(values);
  for (auto& many : content_->many)
    if (many) many->set_parameters(values);
}

std::size_t Equations::input_size(Purpose purpose) const {
  return input_numbers(content_->equations->scene(), purpose);
}

std::size_t Equations::output_size(Purpose purpose) const {
  const mixloop::Scene& scene = content_->equations->scene();
  return mixloop::output_size(inner(purpose), scene.n(), scene.n_u());
}

Status Equations::evaluate(Purpose purpose, const State& at, std::span<const double> input,
                           std::span<double> out) {
  require_asked(content_->asked, purpose);
  const auto n = static_cast<std::size_t>(content_->equations->scene().n());
  const auto or_zeros = [&](std::span<const double> values, const char* what, std::size_t expected) {
    if (values.empty()) return std::span<const double>(content_->zeros).first(expected);
    inside::require_size(what, values.size(), expected);
    return values;
  };
  inside::require_size("psi", at.psi.size(), n);
  inside::require_size("out", out.size(), output_size(purpose));
  return outer(content_->workspace.evaluate(
      inner(purpose),
      {at.psi, or_zeros(at.psid, "psid", n), or_zeros(input, "input", input_size(purpose)), at.t}, out));
}

Status Equations::evaluate_all(Purpose purpose, std::span<const double> psi, std::span<const double> psid,
                               std::span<const double> t, std::span<const double> input,
                               std::span<double> out) {
  require_asked(content_->asked, purpose);
  const auto n = static_cast<std::size_t>(content_->equations->scene().n());
  const std::size_t states = t.size(), takes = input_size(purpose), gives = output_size(purpose);
  inside::require_size("psi", psi.size(), states * n);
  if (!psid.empty()) inside::require_size("psid", psid.size(), states * n);
  if (!input.empty()) inside::require_size("input", input.size(), states * takes);
  inside::require_size("out", out.size(), states * gives);

  auto& many = content_->many[static_cast<std::size_t>(purpose)];
  if (!many && evaluation() == Evaluation::machine_code)
    many.emplace(*content_->equations, inner(purpose), content_->parameters);
  if (many && *many) return outer(many->evaluate({psi, psid, input, t}, out));
  Status status = Status::ok;
  for (std::size_t i = 0; i < states; ++i) {
    const auto one = [i](auto values, std::size_t size) {
      return values.empty() ? values : values.subspan(i * size, size);
    };
    if (evaluate(purpose, {one(psi, n), one(psid, n), t[i]}, one(input, takes), one(out, gives)) !=
        Status::ok)
      status = Status::not_finite;
  }
  return status;
}

std::string cpp_source(const Scene& scene, const std::vector<Purpose>& purposes) {
  return inside::translated(
      [&] { return firmware_source(Inside::of(scene), inner_all(purposes), Trigonometry::inlined); });
}

}  // namespace mixloop::v1
