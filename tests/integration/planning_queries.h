#pragma once
// Random queries on one map, judged by a flood over the same lethal cells and by the checker.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "planning/check.h"
#include "planning/planner.h"

namespace rovigo::planning {

using maps::Cell;
using maps::Costmap;
using maps::OccupancyGrid;

/// Which cells can be reached from each other, by flooding; 0 where the rover cannot be.
inline std::vector<int> components(const Costmap& costmap) {
  std::vector<int> label(costmap.cells.size(), 0);
  int next_label = 0;
  std::deque<Cell> queue;
  for (std::size_t i = 0; i < label.size(); ++i) {
    const Cell seed = costmap.geometry.cell_of(i);
    if (label[i] != 0 || !costmap.is_passable(seed)) continue;
    label[i] = ++next_label;
    queue.push_back(seed);
    while (!queue.empty()) {
      const Cell cell = queue.front();
      queue.pop_front();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          // A diagonal needs both of its neighbours, as in the planner.
          const Cell next{cell.x + dx, cell.y + dy};
          if (!costmap.is_passable(next) || !costmap.is_passable({next.x, cell.y}) ||
              !costmap.is_passable({cell.x, next.y})) {
            continue;
          }
          auto& l = label[costmap.geometry.index_of(next)];
          if (l == 0) {
            l = next_label;
            queue.push_back(next);
          }
        }
      }
    }
  }
  return label;
}

/// What the answer must be, from the costmap alone; nullopt where the start is on lethal ground
/// and an escape may or may not exist.
inline std::optional<PlanStatus> expected(const Planner& planner, const std::vector<int>& labels,
                                          const TPoint2D& start, const TPoint2D& goal) {
  const auto& g = planner.grid().geometry;
  if (!g.contains(start)) return PlanStatus::kStartOutsideMap;
  const Cell from = g.cell_at(start);
  if (OccupancyGrid::is_occupied(planner.grid().at(from))) return PlanStatus::kStartOccupied;
  if (!planner.costmap().is_passable(from)) return std::nullopt;
  if (!g.contains(goal)) return PlanStatus::kGoalOutsideMap;
  const Cell to = g.cell_at(goal);
  if (!planner.costmap().is_passable(to)) return PlanStatus::kGoalOccupied;
  return labels[g.index_of(from)] == labels[g.index_of(to)] ? PlanStatus::kOk : PlanStatus::kNoPath;
}

/// `queries` pairs of points in passable cells, then a third as many anywhere, also off the map.
inline void expect_plans_where_cells_connect(const OccupancyGrid& grid, int queries,
                                             std::uint64_t seed) {
  const maps::RobotModel robot;
  const PlannerConfig config;
  const Planner planner(grid, robot, {}, config);
  const std::vector<int> labels = components(planner.costmap());
  const auto& g = grid.geometry;
  std::vector<Cell> passable;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (labels[i] != 0) passable.push_back(g.cell_of(i));
  }
  ASSERT_FALSE(passable.empty());
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto random_point = [&](bool anywhere) -> TPoint2D {
    if (anywhere) {
      return {g.origin.x + (1.1 * unit(random) - 0.05) * g.width * g.resolution_m,
              g.origin.y + (1.1 * unit(random) - 0.05) * g.height * g.resolution_m};
    }
    const TPoint2D center = g.center_of(passable[random() % passable.size()]);
    return {center.x + (unit(random) - 0.5) * g.resolution_m,
            center.y + (unit(random) - 0.5) * g.resolution_m};
  };

  std::size_t planned = 0;
  std::size_t unsafe = 0;
  for (int i = 0; i < queries + queries / 3; ++i) {
    const bool anywhere = i >= queries;
    const TPoint2D start = random_point(anywhere);
    const TPoint2D goal = random_point(anywhere);
    PlanRequest request;
    request.start = {start.x, start.y, maps::kPi * (2.0 * unit(random) - 1.0)};
    request.start_heading_given = i % 2 == 0;
    request.goal = {goal.x, goal.y, maps::kPi * (2.0 * unit(random) - 1.0)};
    request.goal_heading_given = i % 3 == 0;
    const PlanResult result = planner.plan(request);
    SCOPED_TRACE("pair " + std::to_string(i) + ": " + result.message);

    const auto want = expected(planner, labels, start, goal);
    if (want) {
      EXPECT_STREQ(to_string(result.status), to_string(*want));
    }
    EXPECT_EQ(refusal_code(result.status) == 0, result.status == PlanStatus::kOk);
    if (result.status != PlanStatus::kOk) {
      EXPECT_FALSE(result.message.empty());
      EXPECT_TRUE(result.offending_point.has_value());
      EXPECT_TRUE(result.trajectory.points.empty());
      if (result.nearest_reachable_goal) {
        EXPECT_TRUE(planner.costmap().is_passable(g.cell_at(*result.nearest_reachable_goal)));
      }
      continue;
    }
    ++planned;
    CheckOptions options;
    options.limits = limits_of(robot, config.timing);
    options.robot_radius_m = robot.robot_radius_m;
    options.escape_allowed = result.escape;
    const TrajectoryReport report = check(result.trajectory, grid, options);
    EXPECT_THAT(report.problems, testing::IsEmpty());
    unsafe += report.unsafe_samples;
    const TPose2D& first = result.trajectory.points.front().pose;
    const TPose2D& last = result.trajectory.points.back().pose;
    EXPECT_NEAR(maps::distance(maps::position_of(first), start), 0.0, 1e-9);
    EXPECT_LT(maps::distance(maps::position_of(last), goal), 0.75 * g.resolution_m);
    if (request.goal_heading_given) {
      EXPECT_NEAR(maps::wrap_angle(last.phi - request.goal.phi), 0.0, 1e-3);
    }
    if (request.start_heading_given) {
      EXPECT_NEAR(maps::wrap_angle(first.phi - request.start.phi), 0.0, 1e-9);
    }
  }
  EXPECT_GT(planned, static_cast<std::size_t>(queries) * 4 / 5);
  EXPECT_EQ(unsafe, 0U);
}

}  // namespace rovigo::planning
