// SPDX-License-Identifier: MIT
// The house keeps to its own plan: includes point along the arrows of docs/house.md.
#include "tests/house/arrows.hpp"

#include <gmock/gmock.h>

#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::filesystem::path kRoot = MIXLOOP_SOURCE;

TEST(Arrows, EveryIncludePointsDown) {
  const Arrows arrows = arrows_of(kRoot / "docs/house.md");
  ASSERT_GE(arrows.size(), 20U);
  EXPECT_THAT(includes_against(arrows, kRoot), IsEmpty());
}

TEST(Arrows, AnIncludeAgainstThemIsFound) {
  const ScratchFolder folder;
  const auto planted = [&](const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder.path() / name).parent_path());
    folder.write(name, text);
  };
  planted("plant/fine.cpp", "#include \"dynamics/scene/scene.hpp\"\n#include <vector>\n");
  planted("plant/planted.cpp", "#include \"plant/plant.hpp\"\n\n#include \"loop/simulate.hpp\"\n");
  planted("notation/planted.hpp", "#include \"dynamics/scene/scene.hpp\"\n");
  planted("attic/old.cpp", "\n");
  const auto found = includes_against(arrows_of(kRoot / "docs/house.md"), folder.path());
  EXPECT_THAT(found, testing::UnorderedElementsAre(HasSubstr("plant/planted.cpp:3: plant doesn't know loop"),
                                                   HasSubstr("notation/planted.hpp:1: notation doesn't know"),
                                                   HasSubstr("attic/old.cpp: stands in no room")));
}

}  // namespace
}  // namespace mixloop
