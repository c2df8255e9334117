// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "notation/document.hpp"

namespace mixloop {

/// An experiment's document laid over the one that its `base` names, if any, whose path counts from the
/// folder of `file`: mappings entry by entry, all else in its place; an empty entry takes the base's away.
/// Scenes that the base names still count from its own folder. Throws InputError: "no_such_file",
/// "cyclic_definition" where a base leads back to itself.
NodePtr on_base(const NodePtr& document, const std::filesystem::path& file);

/// An experiment's document as it reads from a file in another folder: its scenes' and samples' paths count
/// from there. `steps`: the way from that folder to its own.
NodePtr as_read_from(const NodePtr& document, const std::filesystem::path& steps);

}  // namespace mixloop
