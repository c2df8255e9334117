// SPDX-License-Identifier: MIT
#include "report/page.hpp"

#include <gmock/gmock.h>

#include <random>

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kPage =
    R"(<html><script id="mixloop-data" type="application/json">null</script></html>)";

ReportedRun noisy_run(std::int64_t ticks, std::size_t capacity) {
  ReportedRun run{{.label = "</script><img src=x onerror=alert(1)>", .rate_hz = 1000, .n = 1},
                  Curves({0, 1, 2}, 1000, capacity),
                  {}};
  std::mt19937 random(21);
  std::normal_distribution<double> noise;
  Tick tick(1);
  for (tick.k = 0; tick.k < ticks; ++tick.k) {
    for (auto* values : {&tick.psi, &tick.psid, &tick.tau, &tick.tau_applied}) (*values)[0] = noise(random);
    run.curves.add(tick);
  }
  return run;
}

// Names come from files of others; the page must not run them.
TEST(Page, TakesDataThatCannotEndItsScript) {
  const std::string page = with_data(kPage, {{"label", "</script><b>"}});
  EXPECT_THAT(page, HasSubstr(R"({"label":"\u003c/script>\u003cb>"})"));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
}

TEST(Page, RefusesOneWithoutAPlaceForData) { EXPECT_THROW(with_data("<html></html>", nullptr), RunFault); }

TEST(Page, CoarsensCurvesUntilItIsSmallEnough) {
  std::vector<ReportedRun> runs;
  runs.push_back(noisy_run(20'000, 1 << 15));
  const std::size_t whole = report_page(kPage, runs, 100'000'000).size();
  EXPECT_EQ(runs[0].curves.width(), 1);
  const std::string small = report_page(kPage, runs, whole / 3);
  EXPECT_LE(small.size(), whole / 3);
  EXPECT_GT(runs[0].curves.width(), 1);
  EXPECT_THAT(small, Not(HasSubstr("<img")));
}

TEST(Page, IsTheSameTextForTheSameRuns) {
  std::vector<ReportedRun> once, again;
  once.push_back(noisy_run(100, 64));
  again.push_back(noisy_run(100, 64));
  EXPECT_EQ(report_page(kPage, once, 1'000'000), report_page(kPage, again, 1'000'000));
}

}  // namespace
}  // namespace mixloop
