// SPDX-License-Identifier: MIT
#pragma once

#include "import/robot.hpp"
#include "import/xml_file.hpp"

namespace mixloop {

/// The robot of a URDF. Throws InputError, with line and column, for a file that urdfdom refuses or whose
/// numbers, names or tree are none.
Robot read_robot(const XmlFile& file);

}  // namespace mixloop
