#include "planning/footprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "maps/error.h"
#include "maps/inflation.h"
#include "planning/check.h"
#include "planning/planner.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

using testing::IsEmpty;

const maps::RobotModel kRobot;  // 0.43 m x 0.41 m: inscribed radius 0.205 m, turning circle 0.594 m

struct Ground {
  explicit Ground(maps::OccupancyGrid g, double margin_m = 0.0)
      : grid(std::move(g)),
        costmap(maps::inflate_safe(grid, {.robot_radius_m = radius()})),
        centers(grid, costmap, radius()),
        space(grid, centers, footprint_of(kRobot), margin_m) {}
  static double radius() { return footprint_of(kRobot).inscribed_radius_m(); }

  maps::OccupancyGrid grid;
  maps::Costmap costmap;
  FreeSpace centers;
  FootprintSpace space;
};

/// 6 x 4 m, a wall of 0.3 m across with a gap, at heights `low` to `high`.
maps::OccupancyGrid rooms_with_gap(double low, double high) {
  auto grid = room(6, 4, 0.02);
  fill(grid, 2.85, 0.0, 3.15, low);
  fill(grid, 2.85, high, 3.15, 4.0);
  return grid;
}

PlannerConfig config_for(const std::string& planner) {
  PlannerConfig config;
  config.planner = planner;
  config.footprint = "rectangle";
  config.ompl.rrtstar_iterations = 2000;
  config.ompl.bitstar_iterations = 4000;
  config.ompl.prmstar_iterations = 1000;
  return config;
}

PlanRequest through_the_wall() {
  PlanRequest request;
  request.start = {1.0, 0.8, 0.5};
  request.start_heading_given = true;
  request.goal = {5.0, 3.2, 1.0};
  request.goal_heading_given = true;
  return request;
}

TEST(Footprint, FitsBetweenWallsOnlyWhenItFacesAlongThem) {
  auto grid = room(3, 3, 0.01);
  fill(grid, 0.0, 0.0, 3.0, 1.25);
  fill(grid, 0.0, 1.75, 3.0, 3.0);  // half a metre is left
  const Ground ground(grid);
  EXPECT_TRUE(ground.space.is_free({1.5, 1.5, 0.0}));
  EXPECT_TRUE(ground.space.is_free({1.5, 1.5, maps::kPi}));
  EXPECT_FALSE(ground.space.is_free({1.5, 1.5, 0.25 * maps::kPi}));
  EXPECT_TRUE(ground.space.drive_is_free({0.5, 1.5}, {2.5, 1.5}));
  EXPECT_FALSE(ground.space.drive_is_free({0.5, 1.46}, {2.5, 1.54}));  // scrapes at both ends
  EXPECT_TRUE(ground.space.turn_is_free({1.5, 1.5}, -0.1, 0.1));
  EXPECT_FALSE(ground.space.turn_is_free({1.5, 1.5}, 0.0, 0.5 * maps::kPi));
  EXPECT_FALSE(ground.space.turn_is_free({1.5, 1.5}, 0.0, maps::kPi)) << "ends fit, between not";
}

TEST(Footprint, AgreesWithTheCheckerOnRandomGrids) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int free = 0, blocked = 0;
  for (int i = 0; i < 20; ++i) {
    auto grid = room(3, 3);
    for (auto& cell : grid.cells) {
      if (unit(random) < 0.02) cell = maps::OccupancyGrid::kOccupied;
    }
    const Ground ground(grid);
    for (int k = 0; k < 300; ++k) {
      const TPose2D pose{3.0 * unit(random), 3.0 * unit(random), 7.0 * unit(random)};
      const double clearance = footprint_clearance(
          grid, pose, {kRobot.footprint_length_m, kRobot.footprint_width_m}, 0.1);
      // A cell whose centre is too near to an obstacle is closed as a whole.
      if (!ground.costmap.is_passable(grid.geometry.cell_at(maps::position_of(pose))) ||
          (clearance > 0.0 && clearance < 1e-6)) {
        continue;
      }
      ASSERT_EQ(ground.space.is_free(pose), clearance > 0.0) << "grid " << i << " pose " << k;
      ++(clearance > 0.0 ? free : blocked);
    }
  }
  EXPECT_GT(free, 300);
  EXPECT_GT(blocked, 50);
}

TEST(Footprint, AFreeTurnIsFreeAtEveryHeadingOfIt) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  auto grid = room(3, 3);
  for (auto& cell : grid.cells) {
    if (unit(random) < 0.02) cell = maps::OccupancyGrid::kOccupied;
  }
  const Ground ground(grid);
  int turned = 0;
  for (int k = 0; k < 20000; ++k) {
    const TPoint2D at{3.0 * unit(random), 3.0 * unit(random)};
    const double from = 6.0 * unit(random), to = 6.0 * unit(random);
    if (!ground.space.turn_is_free(at, from, to)) continue;
    ++turned;
    const double by = maps::wrap_angle(to - from);
    for (int i = 0; i <= 50; ++i) {
      ASSERT_TRUE(ground.space.is_free({at.x, at.y, from + by * i / 50.0}));
    }
  }
  EXPECT_GT(turned, 50);
}

class FootprintPlanners : public testing::TestWithParam<const char*> {};

TEST_P(FootprintPlanners, GoThroughAGapThatTheTurningCircleDoesNotFitIn) {
  const auto grid = rooms_with_gap(1.8, 2.3);
  EXPECT_EQ(Planner(grid, kRobot, {}, {}).plan(through_the_wall()).status, PlanStatus::kNoPath);
  const Planner planner(grid, kRobot, {}, config_for(GetParam()));
  const PlanResult result = planner.plan(through_the_wall());
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.message;
  CheckOptions options;
  options.footprint = {kRobot.footprint_length_m, kRobot.footprint_width_m};
  options.limits = limits_of(kRobot, TimingConfig());
  const TrajectoryReport report = check(result.trajectory, grid, options);
  EXPECT_THAT(report.problems, IsEmpty());
  EXPECT_GT(report.min_clearance_m, 0.0);
  EXPECT_LT(report.min_clearance_m, 0.05);
  EXPECT_NEAR(result.min_clearance_m, report.min_clearance_m, 1e-12);
  EXPECT_LT(result.path_length_m, 6.5);
  EXPECT_NEAR(result.trajectory.points.back().pose.phi, 1.0, 1e-6);
  const PlanResult again = planner.plan(through_the_wall());
  EXPECT_EQ(again.smooth_path.points, result.smooth_path.points) << "same seed, another path";
}

TEST_P(FootprintPlanners, RefuseAGapNarrowerThanTheRover) {
  const Planner planner(rooms_with_gap(1.8, 2.2), kRobot, {}, config_for(GetParam()));
  EXPECT_EQ(planner.plan(through_the_wall()).status, PlanStatus::kNoPath);
}

INSTANTIATE_TEST_SUITE_P(Ompl, FootprintPlanners,
                         testing::Values("rrtconnect", "rrtstar", "bitstar", "prmstar"));

TEST(FootprintPlanner, RefusesAStartThatDoesNotFit) {
  const Planner planner(rooms_with_gap(1.8, 2.3), kRobot, {}, config_for("rrtconnect"));
  PlanRequest request = through_the_wall();
  request.start = {3.0, 2.05, 0.8};
  EXPECT_EQ(planner.plan(request).status, PlanStatus::kStartOccupied);
  request.start.phi = 0.0;
  EXPECT_EQ(planner.plan(request).status, PlanStatus::kOk);
  request.goal = {3.0, 2.05, 0.8};
  EXPECT_EQ(planner.plan(request).status, PlanStatus::kGoalOccupied);
}

TEST(FootprintPlanner, VisitsViaPointsInTheGap) {
  const auto grid = rooms_with_gap(1.8, 2.3);
  const Planner planner(grid, kRobot, {}, config_for("rrtconnect"));
  PlanRequest request = through_the_wall();
  request.via = {{3.0, 2.05}, {4.0, 1.0}};
  const PlanResult result = planner.plan(request);
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.message;
  CheckOptions options;
  options.footprint = {kRobot.footprint_length_m, kRobot.footprint_width_m};
  options.limits = limits_of(kRobot, TimingConfig());
  EXPECT_THAT(check(result.trajectory, grid, options).problems, IsEmpty());
}

TEST(FootprintPlanner, NeedsASamplingPlanner) {
  EXPECT_THROW(Planner(room(3, 3), kRobot, {}, config_for("astar")), maps::InputError);
  EXPECT_THROW(Planner(room(3, 3), kRobot, {}, config_for("thetastar")), maps::InputError);
}

}  // namespace
}  // namespace rovigo::planning
