// SPDX-License-Identifier: MIT
#include "loop/energy_balance.hpp"

#include <algorithm>

#include "dynamics/scene/energy_balance.hpp"

namespace mixloop {

std::string other_work_in(const Experiment& experiment) {
  if (std::string why = other_work(*experiment.scene); !why.empty()) return why;
  const auto changes_parameter = [](const Fault& fault) { return fault.target == Fault::Target::parameter; };
  if (std::ranges::any_of(experiment.plant.faults.scheduled, changes_parameter))
    return "a fault changes a parameter, and the energy with it";
  return {};
}

}  // namespace mixloop
