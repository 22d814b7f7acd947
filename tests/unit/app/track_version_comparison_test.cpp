#include "app/track/version_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::app {
namespace {

void add(TrackResult& result, const std::string& name, int seed, double rms_m, bool passed,
         const std::string& hash) {
  result.runs.push_back({{"name", name},
                         {"seed", seed},
                         {"passed", passed},
                         {"cross_track_rms_m", rms_m},
                         {"log_hash", hash}});
}

TEST(VersionComparison, PairsDrivesByNameAndSeedAndSumsThemUpByGroupAndController) {
  TrackResult before, now;
  add(before, "g/curve/default/0.400", 1, 0.004, false, "a");
  add(before, "g/curve/default/0.400", 2, 0.003, true, "b");
  add(before, "h/curve/default/0.400", 1, 0.002, true, "c");
  add(now, "g/curve/default/0.400", 1, 0.001, true, "d");
  add(now, "g/curve/default/0.400", 2, 0.003, true, "b");
  add(now, "g/curve/default/0.400", 3, 0.900, true, "e");  // was not driven before
  add(now, "h/curve/default/0.400", 1, 0.002, false, "c");
  const auto found = compare_versions(now, before);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].what, "g, default");
  EXPECT_EQ(found[0].drives, 2U);
  EXPECT_EQ(found[0].same, 1U);
  EXPECT_EQ(found[0].passed, 2U);
  EXPECT_EQ(found[0].passed_before, 1U);
  EXPECT_NEAR(found[0].rms_before_m, std::sqrt((16e-6 + 9e-6) / 2.0), 1e-12);
  EXPECT_NEAR(found[0].rms_m, std::sqrt((1e-6 + 9e-6) / 2.0), 1e-12);
  EXPECT_EQ(found[1].passed, 0U);
  EXPECT_EQ(found[2].what, "all");
  EXPECT_EQ(found[2].drives, 3U);
  EXPECT_EQ(comparison_json(found)[2].at("same_to_the_bit"), 2);
}

TEST(VersionComparison, SaysSoWhereNoDriveIsInBoth) {
  TrackResult before, now;
  add(before, "g/curve/default/0.400", 1, 0.004, true, "a");
  add(now, "g/circle/default/0.400", 1, 0.004, true, "a");
  const auto found = compare_versions(now, before);
  EXPECT_TRUE(found.empty());
  const auto rows = comparison_rows(found, "old.json");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].second, "no run is also in old.json");
}

}  // namespace
}  // namespace rovigo::app
