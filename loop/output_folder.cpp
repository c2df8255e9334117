// SPDX-License-Identifier: MIT
#include "loop/output_folder.hpp"

#include <fstream>

#include "notation/errors.hpp"

namespace mixloop {

void prepare_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  const auto probe = folder / ".mixloop-probe";
  const bool writable = std::ofstream(probe).put('x').good();
  std::filesystem::remove(probe, failure);
  if (!writable) throw RunFault("cannot_write", "cannot write into the folder " + folder.string());
}

}  // namespace mixloop
