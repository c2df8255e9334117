// SPDX-License-Identifier: MIT
// A URDF, made a scene and an experiment where it is one.
#include "import/import_urdf.hpp"
#include "tests/fuzz/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mixloop;
  refuses_or_reads("fuzz",
                   [&] { import_urdf(std::string(text_of(data, size)), "fuzz", {.any_inertia = true}); });
  return 0;
}
