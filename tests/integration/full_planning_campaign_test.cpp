// Ten thousand random queries on all maps, as `./run bench planning campaign` makes them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/planning_campaign.h"

namespace rovigo::test {
namespace {

TEST(FullCampaign, TenThousandRandomQueriesOnAllMapsAreAllAnsweredRightly) {
  constexpr std::size_t kQueries = 10000;
  const auto maps = campaign_maps(10);
  CampaignReport sum;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    SCOPED_TRACE(maps[i].first);
    const auto report =
        run_campaign(maps[i].second, {.queries = (kQueries + maps.size() - 1) / maps.size(),
                                      .seed = 1000 + i,
                                      .threads = std::thread::hardware_concurrency()});
    EXPECT_THAT(report.troubles, testing::IsEmpty());
    sum.add(report);
  }
  EXPECT_GE(sum.queries, kQueries);
  EXPECT_GT(sum.planned, kQueries / 3);
  EXPECT_EQ(sum.unsafe_samples, 0U);
  EXPECT_EQ(sum.failures(), 0U);
}

}  // namespace
}  // namespace rovigo::test
