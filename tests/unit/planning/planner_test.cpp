#include "planning/planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "maps/error.h"
#include "planning/check.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// 8 x 6 m, a wall across at x = 4 with a door of 1 m at its upper end, and a closed cell.
maps::OccupancyGrid two_rooms() {
  auto grid = room(8, 6);
  fill(grid, 3.95, 0.0, 4.05, 4.9);
  fill(grid, 6.0, 1.0, 7.0, 1.05);
  fill(grid, 6.0, 2.0, 7.0, 2.05);
  fill(grid, 6.0, 1.0, 6.05, 2.05);
  fill(grid, 7.0, 1.0, 7.05, 2.05);
  return grid;
}

Planner planner_for(const maps::OccupancyGrid& grid, const PlannerConfig& config = {},
                    maps::MapMode mode = maps::MapMode::kKnownFree) {
  maps::InflationConfig inflation;
  inflation.map_mode = mode;
  return Planner(grid, maps::RobotModel(), inflation, config);
}

PlanRequest from_to(const TPoint2D& start, const TPoint2D& goal) {
  PlanRequest request;
  request.start = {start.x, start.y, 0.0};
  request.goal = {goal.x, goal.y, 0.0};
  return request;
}

void expect_sound(const PlanResult& result, const maps::OccupancyGrid& grid) {
  ASSERT_EQ(result.status, PlanStatus::kOk) << result.message;
  CheckOptions options;
  options.limits = limits_of(maps::RobotModel(), TimingConfig());
  options.escape_allowed = result.escape;
  EXPECT_THAT(check(result.trajectory, grid, options).problems, IsEmpty());
}

TEST(Planner, GoesThroughTheDoor) {
  const auto grid = two_rooms();
  const auto result = planner_for(grid).plan(from_to({1, 1}, {5, 1}));
  expect_sound(result, grid);
  EXPECT_GT(result.path_length_m, 8.0);
  EXPECT_LT(result.path_length_m, 11.0);
  EXPECT_GE(result.min_clearance_m, 0.0);
  EXPECT_GT(result.expanded_cells, 100U);
  EXPECT_FALSE(result.escape);
  EXPECT_TRUE(result.message.empty());
  EXPECT_NEAR(result.trajectory.points.back().pose.x, 5.0, 1e-9);
  EXPECT_NEAR(result.trajectory.points.back().pose.y, 1.0, 1e-9);
}

TEST(Planner, TheReportedClearanceIsWhatACheckerMeasures) {
  const auto grid = two_rooms();
  const auto result = planner_for(grid).plan(from_to({1, 1}, {5, 1}));
  CheckOptions options;
  options.clearance_looked_m = 2.0;
  const auto report = check(result.trajectory, grid, options);
  EXPECT_NEAR(result.min_clearance_m, report.min_clearance_m - 0.30, 1e-3);
}

struct Refusal {
  const char* name;
  TPoint2D start;
  TPoint2D goal;
  PlanStatus status;
  int code;
  const char* says;
};

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, NameTheirCauseAndTheWayOut) {
  const Refusal& want = GetParam();
  const auto result = planner_for(two_rooms()).plan(from_to(want.start, want.goal));
  EXPECT_STREQ(to_string(result.status), to_string(want.status)) << result.message;
  EXPECT_EQ(refusal_code(result.status), want.code);
  EXPECT_THAT(result.message, HasSubstr(want.says));
  EXPECT_TRUE(result.trajectory.points.empty());
  EXPECT_TRUE(result.smooth_path.points.empty());
  ASSERT_TRUE(result.offending_point.has_value());
  const bool about_goal = want.code == 204 || want.code == 206 || want.code == 208;
  EXPECT_EQ(result.nearest_reachable_goal.has_value(), about_goal);
}

INSTANTIATE_TEST_SUITE_P(
    TwoRooms, Refusals,
    testing::Values(
        Refusal{
            "StartOutside", {-1, 1}, {5, 1}, PlanStatus::kStartOutsideMap, 203, "the map covers"},
        Refusal{
            "GoalOutside", {1, 1}, {5, 99}, PlanStatus::kGoalOutsideMap, 204, "(5.00, 99.00) m"},
        Refusal{
            "StartInWall", {4, 1}, {5, 1}, PlanStatus::kStartOccupied, 205, "inside an obstacle"},
        Refusal{"GoalInWall", {1, 1}, {4, 1}, PlanStatus::kGoalOccupied, 206, "inside an obstacle"},
        Refusal{"GoalNearWall", {1, 1}, {4.2, 1}, PlanStatus::kGoalOccupied, 206, "robot_radius_m"},
        Refusal{
            "GoalWalledOff", {1, 1}, {6.5, 1.5}, PlanStatus::kNoPath, 208, "nearest reachable"}),
    [](const auto& param) { return std::string(param.param.name); });

TEST(Planner, NonFinitePointsAreOutsideTheMap) {
  const auto planner = planner_for(two_rooms());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(planner.plan(from_to({nan, 1}, {5, 1})).status, PlanStatus::kStartOutsideMap);
  EXPECT_EQ(planner.plan(from_to({1, 1}, {5, 1e300})).status, PlanStatus::kGoalOutsideMap);
}

TEST(Planner, NearestReachableGoalIsBesideTheWallThatClosesItOff) {
  const auto planner = planner_for(two_rooms());
  const auto refused = planner.plan(from_to({1, 1}, {6.5, 1.5}));
  ASSERT_TRUE(refused.nearest_reachable_goal.has_value());
  EXPECT_LT(maps::distance(*refused.nearest_reachable_goal, {6.5, 1.5}), 0.95);
  const auto again = planner.plan(from_to({1, 1}, *refused.nearest_reachable_goal));
  EXPECT_EQ(again.status, PlanStatus::kOk) << again.message;
}

TEST(Planner, AStartInTheBandIsLeftSlowly) {
  const auto grid = two_rooms();
  const auto result = planner_for(grid).plan(from_to({0.2, 3.0}, {2, 2}));
  expect_sound(result, grid);
  EXPECT_TRUE(result.escape);
  EXPECT_LT(result.min_clearance_m, 0.0);
  EXPECT_THAT(result.message, HasSubstr("slowly"));
  for (const auto& p : result.trajectory.points) {
    if (p.pose.x < 0.33) {
      EXPECT_LE(p.speed_m_s, 0.15 + 1e-9);
    }
  }
}

TEST(Planner, StartEqualToGoalIsAPlanWithoutAWay) {
  const auto grid = two_rooms();
  const auto planner = planner_for(grid);
  const auto still = planner.plan(from_to({1, 1}, {1, 1}));
  ASSERT_EQ(still.status, PlanStatus::kOk);
  EXPECT_EQ(still.path_length_m, 0.0);
  ASSERT_FALSE(still.trajectory.points.empty());
  auto turn = from_to({1, 1}, {1, 1});
  turn.start_heading_given = turn.goal_heading_given = true;
  turn.goal.phi = 2.0;
  const auto turned = planner.plan(turn);
  expect_sound(turned, grid);
  EXPECT_NEAR(turned.trajectory.points.back().pose.phi, 2.0, 1e-9);
}

TEST(Planner, KeepsTheHeadingsOfStartAndGoal) {
  const auto grid = two_rooms();
  const auto planner = planner_for(grid);
  for (const double heading : {-3.0, -1.5, 0.0, 0.3, 1.7, 3.1}) {
    auto request = from_to({1, 1}, {5, 1});
    request.start_heading_given = request.goal_heading_given = true;
    request.start.phi = heading;
    request.goal.phi = -heading;
    const auto result = planner.plan(request);
    expect_sound(result, grid);
    EXPECT_NEAR(result.trajectory.points.front().pose.phi, heading, 1e-9);
    EXPECT_NEAR(maps::wrap_angle(result.trajectory.points.back().pose.phi + heading), 0.0, 1e-3);
  }
}

TEST(Planner, PassesThroughViaPointsInTheirOrder) {
  const auto grid = two_rooms();
  auto request = from_to({1, 1}, {5, 1});
  request.via = {{3, 3}, {1, 5}, {7, 5}};
  const auto result = planner_for(grid).plan(request);
  expect_sound(result, grid);
  std::size_t next = 0;
  for (const auto& p : result.trajectory.points) {
    if (next < request.via.size() &&
        maps::distance(maps::position_of(p.pose), request.via[next]) < 0.01) {
      ++next;
    }
  }
  EXPECT_EQ(next, 3U);
}

TEST(Planner, VisitsViaPointsInTheShortestOrderWhenAsked) {
  const auto grid = two_rooms();
  auto request = from_to({1, 1}, {7, 5});
  request.via = {{6, 4}, {1, 3}, {5, 1}, {2, 5}};
  const auto planner = planner_for(grid);
  const auto given = planner.plan(request);
  EXPECT_THAT(given.via_order, testing::ElementsAre(0, 1, 2, 3));
  request.via_order = ViaOrder::kShortest;
  const auto shortest = planner.plan(request);
  expect_sound(shortest, grid);
  EXPECT_THAT(shortest.via_order, testing::ElementsAre(1, 3, 2, 0));
  EXPECT_LT(shortest.path_length_m, given.path_length_m - 5.0);
}

TEST(Planner, AViaPointInAWallIsNamed) {
  auto request = from_to({1, 1}, {5, 1});
  request.via = {{3, 3}, {4, 1}};
  const auto result = planner_for(two_rooms()).plan(request);
  EXPECT_EQ(result.status, PlanStatus::kGoalOccupied);
  EXPECT_THAT(result.message, HasSubstr("via point 2"));
}

TEST(Planner, UnknownGroundIsPassableInMapModeOneOnly) {
  auto grid = two_rooms();
  fill(grid, 3.5, 4.9, 4.5, 6.0, maps::OccupancyGrid::kUnknown);
  EXPECT_EQ(planner_for(grid).plan(from_to({1, 1}, {5, 1})).status, PlanStatus::kNoPath);
  EXPECT_EQ(
      planner_for(grid, {}, maps::MapMode::kUnknownPassable).plan(from_to({1, 1}, {5, 1})).status,
      PlanStatus::kOk);
  const auto through =
      planner_for(grid, {}, maps::MapMode::kEverything).plan(from_to({1, 1}, {5, 1}));
  ASSERT_EQ(through.status, PlanStatus::kOk);
  EXPECT_NEAR(through.path_length_m, 4.0, 0.01);
}

TEST(Planner, SoftCostsKeepAwayFromWalls) {
  const auto grid = room(8, 3);
  PlannerConfig shortest;
  shortest.astar.soft_cost_weight = 0.0;
  PlannerConfig careful;
  careful.astar.soft_cost_weight = 10.0;
  const auto request = from_to({0.5, 0.4}, {7.5, 0.4});
  const auto near = planner_for(grid, shortest).plan(request);
  const Planner wide_berth(grid, {}, {.soft_cost_sigma_m = 0.15}, careful);
  const auto far = wide_berth.plan(request);
  expect_sound(near, grid);
  expect_sound(far, grid);
  const auto height = [](const PlanResult& r) {
    return sample(r.trajectory, 0.5 * r.trajectory.duration_s()).pose.y;
  };
  EXPECT_NEAR(height(near), 0.4, 0.1);
  EXPECT_GT(height(far), 0.55);
}

TEST(Planner, ThetaStarGoesAsStraightAsThereIsRoom) {
  const auto grid = two_rooms();
  PlannerConfig config;
  config.planner = "thetastar";
  const auto any_angle = planner_for(grid, config).plan(from_to({1, 1}, {2.5, 5}));
  expect_sound(any_angle, grid);
  EXPECT_NEAR(any_angle.search_length_m, std::hypot(1.5, 4.0), 0.06);
  config.astar.soft_cost_weight = 0.0;
  config.planner = "astar";
  const auto on_grid = planner_for(grid, config).plan(from_to({1, 1}, {5, 1}));
  config.planner = "thetastar";
  const auto round_the_wall = planner_for(grid, config).plan(from_to({1, 1}, {5, 1}));
  expect_sound(round_the_wall, grid);
  EXPECT_LT(round_the_wall.search_length_m, on_grid.search_length_m);
  EXPECT_EQ(planner_for(grid, config).plan(from_to({1, 1}, {6.5, 1.5})).status,
            PlanStatus::kNoPath);
}

class SamplingPlanners : public testing::TestWithParam<const char*> {};

TEST_P(SamplingPlanners, FindASoundWayAndTheSameOneForTheSameSeed) {
  const auto grid = two_rooms();
  PlannerConfig config;
  config.planner = GetParam();
  config.ompl.rrtstar_iterations = 3000;
  const auto planner = planner_for(grid, config);
  auto request = from_to({1, 1}, {5, 1});
  request.seed = 11;
  const auto first = planner.plan(request);
  const auto second = planner.plan(request);
  expect_sound(first, grid);
  ASSERT_EQ(first.trajectory.points.size(), second.trajectory.points.size());
  for (std::size_t i = 0; i < first.trajectory.points.size(); ++i) {
    ASSERT_EQ(first.trajectory.points[i].pose.x, second.trajectory.points[i].pose.x);
  }
  EXPECT_EQ(planner.plan(from_to({1, 1}, {6.5, 1.5})).status, PlanStatus::kNoPath);
}

INSTANTIATE_TEST_SUITE_P(Ompl, SamplingPlanners,
                         testing::Values("rrtconnect", "rrtstar", "bitstar", "prmstar"));

TEST(Planner, ASamplingPlannerThatRunsOutOfIterationsSaysSo) {
  PlannerConfig config;
  config.planner = "rrtconnect";
  config.ompl.rrtconnect_iterations = 2;
  const auto result = planner_for(two_rooms(), config).plan(from_to({1, 1}, {5, 1}));
  EXPECT_EQ(result.status, PlanStatus::kTimeout);
  EXPECT_EQ(refusal_code(result.status), 207);
  EXPECT_THAT(result.message, HasSubstr("rrtconnect_iterations"));
}

TEST(Planner, QueriesSideBySideGiveWhatTheyGiveAlone) {
  const auto planner = planner_for(two_rooms());
  std::vector<PlanRequest> requests;
  for (int i = 0; i < 12; ++i)
    requests.push_back(from_to({0.6 + 0.2 * i, 1.0}, {5.0, 0.6 + 0.3 * i}));
  std::vector<PlanResult> alone;
  for (const auto& r : requests) alone.push_back(planner.plan(r));
  std::vector<PlanResult> together(requests.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < requests.size(); i += 4) together[i] = planner.plan(requests[i]);
    });
  }
  for (auto& thread : threads) thread.join();
  for (std::size_t i = 0; i < requests.size(); ++i) {
    EXPECT_EQ(alone[i].status, together[i].status);
    EXPECT_EQ(alone[i].path_length_m, together[i].path_length_m);
    EXPECT_EQ(alone[i].trajectory.points.size(), together[i].trajectory.points.size());
  }
}

TEST(Planner, TellsItsStagesInOrder) {
  std::vector<PlanStage> stages;
  auto request = from_to({1, 1}, {5, 1});
  request.on_stage = [&](PlanStage s) { stages.push_back(s); };
  planner_for(two_rooms()).plan(request);
  EXPECT_THAT(stages, testing::ElementsAre(PlanStage::kSearch, PlanStage::kSmooth, PlanStage::kTime,
                                           PlanStage::kDone));
}

TEST(Planner, AnEmptyMapRefusesInsteadOfCrashing) {
  EXPECT_EQ(planner_for(maps::OccupancyGrid()).plan(from_to({0, 0}, {1, 1})).status,
            PlanStatus::kStartOutsideMap);
}

TEST(Planner, AReferenceSplineSaysWhenItCutsThroughAnObstacle) {
  const auto grid = two_rooms();
  PlannerConfig config;
  config.spline.mode = "reference";
  config.spline.smoothing_cells2 = 2000.0;
  const auto cutting = planner_for(grid, config).plan(from_to({1, 1}, {5, 1}));
  ASSERT_EQ(cutting.status, PlanStatus::kOk);
  CheckOptions options;
  options.limits = limits_of(maps::RobotModel(), config.timing);
  const auto report = check(cutting.trajectory, grid, options);
  EXPECT_EQ(cutting.unsafe_samples > 0, report.unsafe_samples > 0);
  EXPECT_GT(cutting.unsafe_samples, 0U) << "such a smoothing no longer cuts this corner";
  EXPECT_THAT(cutting.message, HasSubstr("not safe to drive"));

  const auto open = planner_for(grid, config).plan(from_to({1, 1}, {1, 2}));
  ASSERT_EQ(open.status, PlanStatus::kOk);
  EXPECT_EQ(open.unsafe_samples, 0U);
  EXPECT_TRUE(open.message.empty()) << open.message;
}

TEST(Planner, AReferenceSplineWithoutSmoothingPassesThroughEveryCell) {
  PlannerConfig config;
  config.spline.mode = "reference";
  config.spline.smoothing_cells2 = 0.0;
  for (const TPoint2D goal : {TPoint2D{5, 1}, TPoint2D{1.02, 1}, TPoint2D{1.06, 1.04}}) {
    const auto result = planner_for(two_rooms(), config).plan(from_to({1, 1}, goal));
    ASSERT_EQ(result.status, PlanStatus::kOk);
    for (const TPoint2D& cell : result.grid_path.points) {
      double nearest = 1.0;
      for (const auto& p : result.trajectory.points) {
        nearest = std::min(nearest, maps::distance(maps::position_of(p.pose), cell));
      }
      EXPECT_LT(nearest, 0.005);
    }
  }
}

}  // namespace
}  // namespace rovigo::planning
