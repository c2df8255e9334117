// SPDX-License-Identifier: MIT
#include "loop/experiment.hpp"

#include "library/inside.hpp"

namespace mixloop::v1 {
namespace {

Experiment evaluated_by(Evaluation how, mixloop::Experiment experiment) {
  experiment.evaluation = static_cast<mixloop::Evaluation>(how);
  return Inside::of(std::move(experiment));
}

}  // namespace

Experiment::Experiment(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Experiment Experiment::load(const std::string& file, const std::vector<std::string>& sets, Evaluation how) {
  return inside::translated([&] {
    return evaluated_by(how, load_experiment(std::filesystem::path(file), inside::overrides(sets)));
  });
}

Experiment Experiment::parse(std::string_view text, const std::string& file,
                             const std::vector<std::string>& sets, Evaluation how) {
  return inside::translated([&] {
    return evaluated_by(how, load_experiment(parse_document(text, file), file, inside::overrides(sets)));
  });
}

const std::string& Experiment::name() const { return content_->experiment.name; }
double Experiment::rate() const { return content_->experiment.rate_hz; }
Scene Experiment::scene() const { return Inside::of(content_->experiment.scene); }

Plan::Plan(const Experiment& experiment)
    : content_(inside::translated(
          [&] { return std::make_shared<const Content>(Content{make_plan(Inside::of(experiment))}); })) {}

std::int64_t Plan::ticks() const { return content_->plan.ticks(); }
std::int64_t Plan::start_tick() const { return content_->plan.start_tick(); }
Reference Plan::at(std::int64_t k) const { return inside::seen(content_->plan.at(k)); }

}  // namespace mixloop::v1
