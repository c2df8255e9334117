// SPDX-License-Identifier: MIT
// Which runs are still to be done, and who does them.
#include <gmock/gmock.h>

#include <random>
#include <set>

#include "sweep/runs.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;

TEST(RunsToDo, AreThoseThatNobodyHas) {
  EXPECT_THAT(without(10, {}), ElementsAre(Runs{0, 10}));
  EXPECT_THAT(without(10, {{4, 2}, {0, 1}, {5, 3}}), ElementsAre(Runs{1, 3}, Runs{8, 2}));
  EXPECT_THAT(without(10, {{0, 10}}), ElementsAre());
}

TEST(RunsToDo, EachIsHandedOutOnceWhateverIsDoneAndHoweverTheyAreSplit) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const std::int64_t all = 1 + random() % 200, batch = 1 + random() % 16, of = 1 + random() % 5;
    std::vector<Runs> done;
    std::set<std::int64_t> seen;
    for (int i = 0; i < 4; ++i) {
      const std::int64_t first = random() % all;
      done.push_back({first, 1 + static_cast<std::int64_t>(random() % (all - first))});
      for (std::int64_t run = done.back().first; run < done.back().end(); ++run) seen.insert(run);
    }
    for (std::int64_t index = 0; index < of; ++index) {
      Dispenser dispenser(without(all, done), {batch, index, of});
      std::int64_t total = dispenser.total();
      for (Runs runs = dispenser.next(); runs.count > 0; runs = dispenser.next()) {
        EXPECT_LE(runs.count, batch);
        for (std::int64_t run = runs.first; run < runs.end(); ++run, --total)
          EXPECT_TRUE(seen.insert(run).second) << run;
      }
      EXPECT_EQ(total, 0);
    }
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(all));
  }
}

}  // namespace
}  // namespace mixloop
