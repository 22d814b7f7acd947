// Ten thousand queries on maps that robot users really use: a plan exists exactly when a plain
// search over the same lethal cells connects start and goal, every refusal carries its code, and
// every trajectory passes the checker.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "maps/ros_map.h"
#include "tests/integration/planning_queries.h"
#include "tests/support/run_rovigo.h"

namespace rovigo::planning {
namespace {

class FullRosMaps : public testing::TestWithParam<const char*> {};

TEST_P(FullRosMaps, PlansExistExactlyWhereTheCellsConnect) {
  const auto file = test::test_data() / "maps" / "ros" / (std::string(GetParam()) + ".yaml");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  std::vector<std::string> warnings;
  expect_plans_where_cells_connect(maps::load_ros_map(file, warnings), 1500, 7);
}

INSTANTIATE_TEST_SUITE_P(Data, FullRosMaps,
                         testing::Values("willow-2010-02-18-0.10", "willow-full-0.05",
                                         "tb3_sandbox", "tb3_map", "100by100_15"),
                         [](const auto& param) {
                           std::string name = param.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace rovigo::planning
