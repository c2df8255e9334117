// SPDX-License-Identifier: MIT
#pragma once

#include <urdf_world/types.h>

#include "import/xml_file.hpp"

namespace mixloop {

/// Whether an element is kept from urdfdom, since it would refuse the file for what isn't carried over:
/// materials, and visual and collision shapes that it doesn't know.
bool is_left_out(const XmlFile::Element& element);

/// The file's robot as urdfdom reads it, which prints nothing meanwhile. Throws InputError("invalid_urdf")
/// with urdfdom's own reason for what it refuses.
urdf::ModelInterfaceSharedPtr model_of(const XmlFile& file);

}  // namespace mixloop
