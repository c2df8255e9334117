// SPDX-License-Identifier: MIT
#include "controller/guarded_controller.hpp"

#include "library/inside.hpp"
#include "loop/measured.hpp"

namespace mixloop::v1 {

struct Controller::Content {
  GuardedController controller;
  std::size_t n, n_u;
};

Controller::Controller(const Experiment& experiment)
    : content_(inside::translated([&] {
        const mixloop::Experiment& inner = Inside::of(experiment);
        return std::make_unique<Content>(Content{make_guarded_controller(inner),
                                                 measured_coordinates(inner).size(),
                                                 static_cast<std::size_t>(inner.scene->n_u())});
      })) {}
Controller::Controller(const Controller& other) : content_(std::make_unique<Content>(*other.content_)) {}
Controller::Controller(Controller&&) noexcept = default;
Controller& Controller::operator=(Controller other) noexcept {
  std::swap(content_, other.content_);
  return *this;
}
Controller::~Controller() = default;

void Controller::torque(const State& measured, const Reference& desired, std::span<double> tau) {
  inside::require_size("psi", measured.psi.size(), content_->n);
  inside::require_size("psid", measured.psid.size(), content_->n);
  for (const auto& values : {desired.psi, desired.psid, desired.psidd})
    inside::require_size("a reference", values.size(), content_->n_u);
  inside::require_size("tau", tau.size(), content_->n_u);
  content_->controller.torque({measured.psi, measured.psid, measured.t}, inside::meant(desired), tau);
}

}  // namespace mixloop::v1
