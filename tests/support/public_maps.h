#pragma once
// The maps of others that planning is tested on, by the quick tests in part and the long ones
// whole.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "maps/movingai.h"
#include "maps/ros_map.h"
#include "planning/planner.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::test {

inline auto movingai_maps() {
  return testing::Values("Paris_1_1024", "maze512-8-0", "64room_000", "random512-35-0", "orz700d");
}

inline auto ros_maps() {
  return testing::Values("willow-2010-02-18-0.10", "willow-full-0.05", "tb3_sandbox", "tb3_map",
                         "100by100_15");
}

/// The map's name with what a test's name may hold.
inline std::string map_test_name(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

/// Some scenario files print six significant digits: half of the last one is rounding.
inline double tolerance_of(double published) {
  const double last_digit = std::pow(10.0, std::floor(std::log10(std::max(published, 1.0))) - 5.0);
  return std::max(1e-4, 0.51 * last_digit);
}

/// Every `step`-th problem of a MovingAI map has the published optimal length.
inline void expect_published_lengths(const std::string& map, std::size_t step) {
  const auto file = test_data() / "maps" / "movingai" / (map + ".map");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  planning::PointPlanner planner(maps::load_movingai_map(file), maps::MapMode::kKnownFree);
  const auto problems = maps::load_movingai_scenario(file.string() + ".scen");
  ASSERT_GT(problems.size(), 500U);
  for (std::size_t i = 0; i < problems.size(); i += step) {
    const auto result = planner.query(problems[i].start(), problems[i].goal());
    ASSERT_EQ(result.status, planning::PlanStatus::kOk)
        << "problem " << i << ": " << result.message;
    const double published = problems[i].optimal_length;
    ASSERT_NEAR(result.length_m, published, tolerance_of(published)) << "problem " << i;
    ASSERT_NEAR(planning::length_m(result.path), result.length_m, 1e-6) << "problem " << i;
  }
}

}  // namespace rovigo::test
