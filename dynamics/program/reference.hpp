// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/procedure/purpose.hpp"
#include "dynamics/program/routine.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// The procedure itself as a routine, without a program: what programs are held against.
std::unique_ptr<const Routine> reference_routine(std::shared_ptr<const Scene> scene, Purpose purpose);

}  // namespace mixloop
