// Random queries on everybody's maps: a plan exists exactly when a plain flood over the same lethal
// cells connects start and goal, every refusal carries its code, every trajectory passes the
// checker.

#include "tests/support/planning_campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/public_maps.h"

namespace rovigo::test {
namespace {

constexpr std::size_t kQueries = 60;

void expect_all_right(const maps::OccupancyGrid& grid, std::uint64_t seed) {
  const CampaignReport report = run_campaign(grid, {.queries = kQueries, .seed = seed});
  EXPECT_EQ(report.failures(), 0U);
  EXPECT_THAT(report.troubles, testing::IsEmpty());
  EXPECT_GT(report.planned, kQueries / 3);
  EXPECT_GT(report.samples, 100 * kQueries);
}

class RosMaps : public testing::TestWithParam<const char*> {};

TEST_P(RosMaps, RandomQueriesAreAllAnsweredRightly) {
  const auto file = test_data() / "maps" / "ros" / (std::string(GetParam()) + ".yaml");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  std::vector<std::string> warnings;
  expect_all_right(maps::load_ros_map(file, warnings), 42);
}

INSTANTIATE_TEST_SUITE_P(Data, RosMaps, ros_maps(), map_test_name);

TEST(RandomWorlds, RandomQueriesAreAllAnsweredRightly) {
  for (std::uint64_t seed = 101; seed <= 104; ++seed) {
    SCOPED_TRACE(testing::Message() << "random:" << seed);
    expect_all_right(random_world_grid(seed), seed);
    expect_all_right(speckled(random_world_grid(seed), seed), seed);
  }
}

TEST(Campaign, ItsReportDoesNotDependOnTheNumberOfThreads) {
  const maps::OccupancyGrid grid = random_world_grid(7);
  const auto one = run_campaign(grid, {.queries = 40, .seed = 3, .threads = 1});
  const auto three = run_campaign(grid, {.queries = 40, .seed = 3, .threads = 3});
  EXPECT_EQ(one.planned, three.planned);
  EXPECT_EQ(one.samples, three.samples);
  EXPECT_EQ(one.length_m, three.length_m);
}

TEST(Campaign, FindsPlansThatComeTooNear) {
  const auto report = run_campaign(
      random_world_grid(8), {.queries = 40, .seed = 3, .inflation = {.robot_radius_m = 0.25}});
  EXPECT_GT(report.unsafe_samples, 0U);
  EXPECT_GT(report.failures(), 0U);
}

}  // namespace
}  // namespace rovigo::test
