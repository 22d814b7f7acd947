#include "planning/escape.h"

#include <gtest/gtest.h>

#include "maps/inflation.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

struct World {
  maps::OccupancyGrid grid;
  maps::Costmap costmap;
  FreeSpace space;
  explicit World(const maps::OccupancyGrid& g)
      : grid(g),
        costmap(maps::inflate_safe(grid, {.robot_radius_m = 0.3})),
        space(grid, costmap, 0.3) {}
  std::optional<std::vector<TPoint2D>> escape(const TPoint2D& start, double most = 1.0) const {
    return find_escape(grid, space, start, most);
  }
};

TEST(Escape, LeavesAWallStraightAway) {
  const World world(room(4, 4));
  const auto way = world.escape({0.20, 2.0});
  ASSERT_TRUE(way.has_value());
  ASSERT_EQ(way->size(), 2U);
  EXPECT_TRUE(world.space.is_free(way->back()));
  EXPECT_LT(maps::distance(way->front(), way->back()), 0.25);
  EXPECT_GE(world.space.clearance(way->front(), way->back(), 1.0), 0.15 - 1e-6);
}

TEST(Escape, DoesNotTakeTheNearestFreeCellThroughAWall) {
  auto grid = room(4, 4);
  fill(grid, 1.0, 0.0, 1.1, 3.0);  // free ground on both sides; the start is left of it
  const World world(grid);
  const auto way = world.escape({0.90, 1.5});
  ASSERT_TRUE(way.has_value());
  EXPECT_LT(way->back().x, 1.0);
}

TEST(Escape, BendsWhereNoStraightWayKeepsClear) {
  auto grid = room(6, 6);
  fill(grid, 0.0, 0.0, 6.0, 6.0);
  // A niche 0.5 m wide (too narrow) that opens round a corner.
  fill(grid, 1.0, 1.0, 1.5, 2.4, maps::OccupancyGrid::kFree);
  fill(grid, 1.0, 1.9, 4.0, 4.0, maps::OccupancyGrid::kFree);
  const World world(grid);
  const auto way = world.escape({1.25, 1.3}, 3.0);
  ASSERT_TRUE(way.has_value());
  EXPECT_TRUE(world.space.is_free(way->back()));
  for (std::size_t i = 1; i < way->size(); ++i) {
    EXPECT_GT(world.space.clearance((*way)[i - 1], (*way)[i], 1.0), 0.19);
  }
}

TEST(Escape, IsRefusedFromAnObstacleOrWhenFreeGroundIsFar) {
  auto grid = room(6, 2);
  fill(grid, 0.0, 0.5, 6.0, 2.0);  // leaves a slot 0.45 m high, narrower than the rover
  const World world(grid);
  EXPECT_FALSE(world.escape({0.02, 1.0}).has_value());
  EXPECT_FALSE(world.escape({3.0, 0.27}).has_value());
}

TEST(Escape, LeavesUnknownGround) {
  auto grid = room(4, 4);
  fill(grid, 1.8, 1.8, 2.2, 2.2, maps::OccupancyGrid::kUnknown);
  const World world(grid);
  const auto way = world.escape({2.0, 2.0});
  ASSERT_TRUE(way.has_value());
  EXPECT_LT(maps::distance(way->front(), way->back()), 0.35);
}

TEST(Escape, APointTooNearInAPassableCellMovesLessThanACell) {
  const World world(room(4, 4));
  // The wall's edge is at 0.05; the cell [0.35, 0.40) has its centre at 0.375, 0.325 m away.
  const auto near = free_point_in_cell(world.space, {0.3501, 2.0});
  ASSERT_TRUE(near.has_value());
  EXPECT_TRUE(near->x >= 0.35);
  EXPECT_EQ(near->x, 0.3501);  // exactly 0.3 m is enough
  auto shifted = room(4, 4);
  fill(shifted, 0.0, 0.0, 0.08, 4.0);  // edge at 0.10; cell [0.40, 0.45): centre 0.325 m away
  const World tight(shifted);
  EXPECT_FALSE(free_point_in_cell(tight.space, {0.39, 2.0}).has_value());
}

}  // namespace
}  // namespace rovigo::planning
