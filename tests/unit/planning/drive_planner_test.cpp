#include "planning/drive_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/footprint_check.h"
#include "planning/refusal.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

DrivePlanner planner_for(const maps::OccupancyGrid& grid, const PlannerConfig& config = {}) {
  return DrivePlanner(grid, maps::RobotModel(), maps::InflationConfig(), config);
}

PlanRequest from_to(const TPoint2D& start, const TPoint2D& goal) {
  PlanRequest request;
  request.start = {start.x, start.y, 0.0};
  request.goal = {goal.x, goal.y, 0.0};
  return request;
}

/// 8 x 4 m, a wall across at x = 4 with a gap of `door_m` in the middle.
maps::OccupancyGrid with_door(double door_m) {
  auto grid = room(8, 4);
  fill(grid, 3.95, 0.0, 4.05, 2.0 - door_m / 2);
  fill(grid, 3.95, 2.0 + door_m / 2, 4.05, 4.0);
  return grid;
}

double least_room(const maps::OccupancyGrid& grid, const PlanResult& result) {
  const maps::RobotModel robot;
  double least = 1.0;
  for (const auto& p : result.trajectory.points) {
    least = std::min(least,
                     footprint_clearance(grid, p.pose,
                                         {robot.footprint_length_m, robot.footprint_width_m}, 1.0));
  }
  return least;
}

TEST(DrivePlanner, KeepsTheMarginWhereTheWayAllows) {
  auto grid = room(8, 4);
  fill(grid, 3.95, 0.0, 4.05, 2.0);
  const auto request = from_to({1, 1}, {7, 1});
  PlannerConfig shortest;
  shortest.astar.soft_cost_weight = 0.0;
  const PlanResult plain =
      Planner(grid, maps::RobotModel(), maps::InflationConfig(), shortest).plan(request);
  const PlanResult driven = planner_for(grid, shortest).plan(request);
  ASSERT_EQ(driven.status, PlanStatus::kOk) << driven.message;
  EXPECT_THAT(driven.message, IsEmpty());
  EXPECT_GE(driven.min_clearance_m, 0.06 - 0.036) << "a margin, to within half a cell's diagonal";
  EXPECT_LT(plain.min_clearance_m, driven.min_clearance_m);
}

TEST(DrivePlanner, PassesADoorTooNarrowForTheMarginAndSaysSo) {
  const auto grid = with_door(0.7);
  const PlanResult driven = planner_for(grid).plan(from_to({1, 0.5}, {7, 3.5}));
  ASSERT_EQ(driven.status, PlanStatus::kOk) << driven.message;
  EXPECT_THAT(driven.message, HasSubstr("less than drive_margin_m"));
  EXPECT_GE(driven.min_clearance_m, 0.0);
  EXPECT_GE(least_room(grid, driven), 0.045) << "straight through, so the body has room";
}

TEST(DrivePlanner, KeepsTheWholeRoverOffUnseenGround) {
  auto grid = room(8, 4);
  fill(grid, 3.0, 0.0, 5.0, 2.0, maps::OccupancyGrid::kUnknown);
  const PlanResult driven = planner_for(grid).plan(from_to({1, 1.0}, {7, 1.0}));
  ASSERT_EQ(driven.status, PlanStatus::kOk) << driven.message;
  for (const auto& p : driven.trajectory.points) {
    if (p.pose.x > 3.0 && p.pose.x < 5.0) {
      EXPECT_GE(p.pose.y, 2.0 + 0.30);
    }
  }
}

TEST(DrivePlanner, RefusesAGoalInAStripOfSeenGroundNarrowerThanTheRover) {
  auto grid = room(8, 4);
  fill(grid, 3.0, 0.0, 8.0, 4.0, maps::OccupancyGrid::kUnknown);
  fill(grid, 3.0, 1.9, 7.0, 2.2, maps::OccupancyGrid::kFree);
  const auto request = from_to({1, 1.0}, {6.5, 2.05});
  ASSERT_EQ(Planner(grid, maps::RobotModel(), maps::InflationConfig(), {}).plan(request).status,
            PlanStatus::kOk);
  const PlanResult driven = planner_for(grid).plan(request);
  EXPECT_NE(driven.status, PlanStatus::kOk);
  EXPECT_THAT(driven.message, HasSubstr("nobody has seen"));
  ASSERT_TRUE(driven.nearest_reachable_goal.has_value());
  EXPECT_LT(driven.nearest_reachable_goal->x, 3.0);
}

// The goal stands in an obstacle; near to it there is ground that plans may end on and drives not.
TEST(DrivePlanner, NamesAPlaceThatDrivesReachWhereTheGoalIsAnObstacle) {
  auto grid = room(8, 4);
  fill(grid, 3.0, 0.0, 8.0, 4.0, maps::OccupancyGrid::kUnknown);
  fill(grid, 3.0, 1.6, 7.0, 2.2, maps::OccupancyGrid::kFree);
  fill(grid, 6.0, 1.6, 7.0, 2.2, maps::OccupancyGrid::kOccupied);
  const PlanResult refused = planner_for(grid).plan(from_to({1, 1.9}, {6.5, 1.9}));
  EXPECT_EQ(refused.status, PlanStatus::kGoalOccupied) << refused.message;
  ASSERT_TRUE(refused.nearest_reachable_goal.has_value());
  const TPoint2D named = *refused.nearest_reachable_goal;
  EXPECT_THAT(refused.message, HasSubstr(text_of(named)));
  EXPECT_EQ(planner_for(grid).plan(from_to({1, 1.9}, named)).status, PlanStatus::kOk);
}

TEST(DrivePlanner, WhereARoverHasBeenNothingStands) {
  auto grid = room(8, 4);
  fill(grid, 3.0, 0.0, 8.0, 4.0, maps::OccupancyGrid::kUnknown);
  fill(grid, 3.0, 1.8, 7.0, 2.25, maps::OccupancyGrid::kFree);  // what its body swept
  std::vector<TPoint2D> been;
  for (double x = 1.0; x <= 6.5; x += 0.02) been.push_back({x, 2.025});
  const PlanResult driven =
      DrivePlanner(grid, maps::RobotModel(), maps::InflationConfig(), {}, been)
          .plan(from_to({1, 2.025}, {6.5, 2.025}));
  EXPECT_EQ(driven.status, PlanStatus::kOk) << driven.message;
}

TEST(DrivePlanner, ForgivesGapsBetweenTheCamerasRays) {
  auto grid = room(8, 4);
  for (int x = 60; x < 100; x += 2) grid.at({x, 40}) = maps::OccupancyGrid::kUnknown;
  const PlanResult driven = planner_for(grid).plan(from_to({1, 2.2}, {7, 2.2}));
  ASSERT_EQ(driven.status, PlanStatus::kOk) << driven.message;
  EXPECT_LT(driven.path_length_m, 6.1) << "no way round them";
}

TEST(DrivePlanner, RefusesToTurnBesideAWallAndOffersWhereItMay) {
  const auto grid = room(8, 4);
  auto request = from_to({1, 2}, {4, 0.36});
  request.goal.phi = 0.8;  // a corner of the body towards the wall
  request.goal_heading_given = true;
  const PlanResult refused = planner_for(grid).plan(request);
  EXPECT_EQ(refused.status, PlanStatus::kGoalOccupied) << refused.message;
  EXPECT_THAT(refused.message, HasSubstr("drive_margin_m"));
  ASSERT_TRUE(refused.nearest_reachable_goal.has_value());
  request.goal.x = refused.nearest_reachable_goal->x;
  request.goal.y = refused.nearest_reachable_goal->y;
  EXPECT_EQ(planner_for(grid).plan(request).status, PlanStatus::kOk);
}

TEST(DrivePlanner, LeavesAStartBesideAWall) {
  const auto grid = room(8, 4);
  const PlanResult driven = planner_for(grid).plan(from_to({1, 0.37}, {7, 2}));
  EXPECT_EQ(driven.status, PlanStatus::kOk) << driven.message;
}

TEST(DrivePlanner, WithoutAMarginPlansAsPlannerDoes) {
  const auto grid = with_door(1.0);
  PlannerConfig config;
  config.drive_margin_m = 0.0;
  const auto request = from_to({1, 0.5}, {7, 3.5});
  const Path plain =
      Planner(grid, maps::RobotModel(), maps::InflationConfig(), config).plan(request).smooth_path;
  const Path driven = planner_for(grid, config).plan(request).smooth_path;
  ASSERT_EQ(driven.points.size(), plain.points.size());
  for (std::size_t i = 0; i < plain.points.size(); ++i) {
    EXPECT_EQ(driven.points[i].x, plain.points[i].x);
    EXPECT_EQ(driven.points[i].y, plain.points[i].y);
  }
}

}  // namespace
}  // namespace rovigo::planning
