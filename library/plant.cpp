// SPDX-License-Identifier: MIT
#include "plant/plant.hpp"

#include "library/inside.hpp"
#include "loop/measured.hpp"

namespace mixloop::v1 {
namespace {

mixloop::Plant plant_of(const mixloop::Experiment& experiment, const mixloop::Plan& plan) {
  if (experiment.plant.continuous)
    throw Error("out_of_range", {experiment.file.string()},
                "plant.control is 'continuous': a control law is asked at every stage of the integrator, and "
                "there is no tick to command; expected 'held', or simulate()");
  return make_plant(experiment, plan);
}

}  // namespace

struct [[gnu::visibility("hidden")]] Plant::Content {
  mixloop::Plant plant;
  std::vector<double> psi, psid;  ///< measured
};

Plant::Plant(const Experiment& experiment, const Plan& plan)
    : content_(inside::translated([&] {
        const auto n = measured_coordinates(Inside::of(experiment)).size();
        return std::make_unique<Content>(Content{plant_of(Inside::of(experiment), Inside::of(plan)),
                                                 std::vector<double>(n), std::vector<double>(n)});
      })) {}
Plant::Plant(const Plant& other) : content_(std::make_unique<Content>(*other.content_)) {}
Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant other) noexcept {
  std::swap(content_, other.content_);
  return *this;
}
Plant::~Plant() = default;

std::int64_t Plant::tick() const { return content_->plant.tick(); }

State Plant::state() const {
  const mixloop::Plant& plant = content_->plant;
  return {plant.psi(), plant.psid(), plant.time()};
}

State Plant::measured() {
  if (content_->plant.measures_exactly()) return state();
  content_->plant.measure(content_->psi, content_->psid);
  return {content_->psi, content_->psid, content_->plant.time()};
}

std::span<const double> Plant::applied() const { return content_->plant.applied(); }
double Plant::work() const { return content_->plant.work(); }

void Plant::advance(std::span<const double> tau) {
  inside::require_size("tau", tau.size(), content_->plant.applied().size());
  content_->plant.command(tau);
  content_->plant.advance();
}

}  // namespace mixloop::v1
