// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mixloop {

/// The folder of the programs that a person calls, where the running one lies, or beside which.
std::string own_folder();

/// What they need and nobody calls: a program or a module in lib/mixloop.
std::string part(const std::string& name);

/// What we install beside our commands: a file or folder below share/mixloop.
std::string shared_file(const std::string& name);

/// A text for the person who called us, whose commands work from where they stand: `mixloop COMMAND` by its
/// path where PATH finds no mixloop or another one, files of `experiments/`, `scenes/` and `docs/` where they
/// are installed unless there is such a file here.
std::string as_called(const std::string& text);

}  // namespace mixloop
