// Planning on maps that robot users really use: a plan exists exactly when a plain search over the
// same lethal cells connects start and goal, every refusal carries its code, and every trajectory
// passes the checker.

#include "tests/integration/planning_queries.h"
#include "tests/support/public_maps.h"

namespace rovigo::planning {
namespace {

class RosMaps : public testing::TestWithParam<const char*> {};

TEST_P(RosMaps, PlansExistExactlyWhereTheCellsConnect) {
  const auto file = test::test_data() / "maps" / "ros" / (std::string(GetParam()) + ".yaml");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  std::vector<std::string> warnings;
  expect_plans_where_cells_connect(maps::load_ros_map(file, warnings), 100, 42);
}

INSTANTIATE_TEST_SUITE_P(Data, RosMaps, test::ros_maps(), test::map_test_name);

}  // namespace
}  // namespace rovigo::planning
