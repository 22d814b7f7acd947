// Point queries on the MovingAI benchmark: the published optimal lengths.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "maps/movingai.h"
#include "planning/planner.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::planning {
namespace {

/// Some scenario files print six significant digits: half of the last one is rounding.
double tolerance(double published) {
  const double last_digit = std::pow(10.0, std::floor(std::log10(std::max(published, 1.0))) - 5.0);
  return std::max(1e-4, 0.51 * last_digit);
}

class MovingAi : public testing::TestWithParam<const char*> {};

TEST_P(MovingAi, EveryTwentiethProblemHasThePublishedLength) {
  const auto folder = test::test_data() / "maps" / "movingai";
  const auto file = folder / (std::string(GetParam()) + ".map");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  PointPlanner planner(maps::load_movingai_map(file), maps::MapMode::kKnownFree);
  const auto problems = maps::load_movingai_scenario(file.string() + ".scen");
  ASSERT_GT(problems.size(), 500U);
  for (std::size_t i = 0; i < problems.size(); i += 20) {
    const auto result = planner.query(problems[i].start(), problems[i].goal());
    ASSERT_EQ(result.status, PlanStatus::kOk) << "problem " << i << ": " << result.message;
    const double published = problems[i].optimal_length;
    ASSERT_NEAR(result.length_m, published, tolerance(published)) << "problem " << i;
    ASSERT_NEAR(length_m(result.path), result.length_m, 1e-6) << "problem " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Data, MovingAi,
                         testing::Values("Paris_1_1024", "maze512-8-0", "64room_000",
                                         "random512-35-0", "orz700d"),
                         [](const auto& param) {
                           std::string name = param.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace rovigo::planning
