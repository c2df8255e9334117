// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/equations.hpp"
#include "dynamics/procedure/workspace.hpp"
#include "report/tick.hpp"

namespace mixloop {

/// What a scene adds to a tick of which psi is known: dependent coordinates always; and, where a log has no
/// TRUTH, the end effector's motion under the torque and the energies.
class Mechanism {
 public:
  Mechanism(std::shared_ptr<const Scene> scene, std::vector<double> parameters);

  const Scene& scene() const { return *scene_; }
  void complete(Tick& tick);

 private:
  std::shared_ptr<const Scene> scene_;
  Model<double> model_;
  Workspace<double> ws_;
  Equations::Workspace dynamics_;
  std::vector<double> psidd_, hand_;
};

}  // namespace mixloop
