#include "app/track/controller_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::app {
namespace {

void add(TrackResult& result, const std::string& name, int seed, double rms_m,
         const std::string& status = "ok") {
  result.runs.push_back(
      {{"name", name}, {"seed", seed}, {"status", status}, {"cross_track_rms_m", rms_m}});
}

TEST(ControllerComparison, PairsDrivesThatDifferInTheirControllerOnly) {
  TrackResult result;
  add(result, "g/curve/default/0.400", 1, 0.001);
  add(result, "g/curve/default/0.400", 2, 0.002);
  add(result, "g/curve/default/0.800", 1, 0.100);  // nobody drove the reference so fast
  add(result, "g/curve/reference/0.400", 1, 0.010);
  add(result, "g/curve/reference/0.400", 2, 0.010);
  add(result, "other/curve/default/0.400", 1, 0.100);
  const auto found = compare_controllers(result);
  ASSERT_EQ(found.size(), 2U);  // the trajectory, and its group
  EXPECT_EQ(found[0].what, "g, curve");
  EXPECT_EQ(found[0].drives, 2U);
  EXPECT_NEAR(found[0].rms_m, std::sqrt((1e-6 + 4e-6) / 2.0), 1e-12);
  EXPECT_NEAR(found[0].ratio, 0.010 / found[0].rms_m, 1e-9);
  EXPECT_NEAR(found[0].median_ratio, 7.5, 1e-9);
}

TEST(ControllerComparison, ALawThatRunsAwayIsToldApartFromOneThatArrives) {
  TrackResult result;
  add(result, "g/a/default/0.400", 1, 0.002);
  add(result, "g/a/reference/0.400", 1, 0.010);
  add(result, "g/b/default/0.400", 1, 0.002);
  add(result, "g/b/reference/0.400", 1, 20.0, "collision");
  const auto group = compare_controllers(result).back();
  EXPECT_EQ(group.what, "g");
  EXPECT_EQ(group.reference_arrived, 1U);
  EXPECT_GT(group.ratio, 5000.0);
  EXPECT_NEAR(group.arrived_ratio, 5.0, 1e-9);
}

TEST(ControllerComparison, NothingToCompareGivesNothingAndTwoPerfectDrivesAreEqual) {
  TrackResult result;
  add(result, "g/a/default/0.400", 1, 0.0);
  EXPECT_TRUE(compare_controllers(result).empty());
  add(result, "g/a/reference/0.400", 1, 0.0);
  EXPECT_EQ(compare_controllers(result).front().ratio, 1.0);
}

}  // namespace
}  // namespace rovigo::app
