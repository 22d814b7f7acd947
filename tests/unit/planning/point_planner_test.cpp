#include <gtest/gtest.h>

#include <cmath>

#include "planning/planner.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

TEST(PointPlanner, AnswersOnTheRawGrid) {
  const auto grid = grid_of({".....", ".###.", "....."}, 2.0);
  const auto answer = plan_point(grid, {5.0, 1.0}, {5.0, 5.0});
  ASSERT_EQ(answer.status, PlanStatus::kOk) << answer.message;
  EXPECT_DOUBLE_EQ(answer.length_m, 12.0);
  EXPECT_EQ(answer.path.points.size(), 7U);
  EXPECT_EQ(plan_point(grid, {5.0, 1.0}, {5.0, 3.0}).status, PlanStatus::kGoalOccupied);
  EXPECT_EQ(plan_point(grid, {5.0, 3.0}, {5.0, 1.0}).status, PlanStatus::kStartOccupied);
  EXPECT_EQ(plan_point(grid, {5.0, 7.0}, {5.0, 1.0}).status, PlanStatus::kStartOutsideMap);
  EXPECT_EQ(plan_point(grid, {5.0, 1.0}, {11.0, 1.0}).status, PlanStatus::kGoalOutsideMap);
}

TEST(PointPlanner, MapModesDecideAboutUnknownCells) {
  const auto grid = grid_of({".?.", "###"}, 1.0);
  EXPECT_EQ(plan_point(grid, {0.5, 1.5}, {2.5, 1.5}).status, PlanStatus::kNoPath);
  EXPECT_EQ(plan_point(grid, {0.5, 1.5}, {2.5, 1.5}, maps::MapMode::kUnknownPassable).length_m,
            2.0);
  EXPECT_EQ(plan_point(grid, {0.5, 0.5}, {2.5, 0.5}, maps::MapMode::kEverything).length_m, 2.0);
}

}  // namespace
}  // namespace rovigo::planning
