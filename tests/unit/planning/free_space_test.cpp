#include "planning/free_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "maps/inflation.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

struct World {
  maps::OccupancyGrid grid;
  maps::Costmap costmap;
  FreeSpace space;
  World(const maps::OccupancyGrid& g, double radius_m)
      : grid(g),
        costmap(maps::inflate_safe(grid, {.robot_radius_m = radius_m})),
        space(grid, costmap, radius_m) {}
};

double brute_force(const maps::OccupancyGrid& grid, const TPoint2D& p) {
  double best = 1e9;
  const double half = 0.5 * grid.geometry.resolution_m;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!maps::OccupancyGrid::is_occupied(grid.cells[i])) continue;
    const TPoint2D c = grid.geometry.center_of(grid.geometry.cell_of(i));
    best = std::min(best, std::hypot(std::max(0.0, std::abs(p.x - c.x) - half),
                                     std::max(0.0, std::abs(p.y - c.y) - half)));
  }
  return best;
}

TEST(FreeSpace, SegmentClearanceIsTheLeastOfItsPoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  maps::OccupancyGrid grid = grid_of(std::vector<std::string>(30, std::string(30, '.')), 0.1);
  for (auto& cell : grid.cells) cell = unit(random) < 0.03 ? 100 : 0;
  const World world(grid, 0.15);
  for (int i = 0; i < 200; ++i) {
    const TPoint2D a{3.0 * unit(random), 3.0 * unit(random)};
    const TPoint2D b{a.x + unit(random) - 0.5, a.y + unit(random) - 0.5};
    double sampled = 2.0;
    for (int k = 0; k <= 400; ++k) {
      const double f = k / 400.0;
      sampled =
          std::min(sampled, brute_force(grid, {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)}));
    }
    const double exact = world.space.clearance(a, b, 2.0);
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_GE(exact, sampled - 0.5 * maps::distance(a, b) / 400.0 - 1e-12);
    const Path path{{a, {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}, b}};
    EXPECT_NEAR(world.space.clearance(path, 2.0), exact, 1e-12);
  }
}

TEST(FreeSpace, FreeMeansTheRadiusIsKeptBetweenCellCentresToo) {
  // One obstacle cell; its edge is at x = 1.1.
  auto grid = grid_of(std::vector<std::string>(30, std::string(30, '.')), 0.1);
  grid.at({10, 15}) = maps::OccupancyGrid::kOccupied;
  const World world(grid, 0.35);
  EXPECT_TRUE(world.space.is_free({1.4501, 1.55}));
  EXPECT_FALSE(world.space.is_free({1.4499, 1.55}));
  EXPECT_TRUE(world.space.is_free({1.4501, 1.0}, {1.4501, 2.0}));
  EXPECT_FALSE(world.space.is_free({1.4499, 1.0}, {1.4499, 2.0}));
  EXPECT_FALSE(world.space.is_free({1.4501, 1.0}, {1.4501, 2.0}, 0.01));
}

TEST(FreeSpace, UnknownGroundAndTheOutsideAreNotFree) {
  const World world(grid_of({"....", "..?.", "....", "...."}, 1.0), 0.1);
  EXPECT_TRUE(world.space.is_free({0.5, 2.5}, {1.9, 2.5}));
  EXPECT_FALSE(world.space.is_free({0.5, 2.5}, {2.1, 2.5}));
  EXPECT_FALSE(world.space.is_free({0.5, 0.5}, {-0.5, 0.5}));
  EXPECT_FALSE(world.space.is_free({std::nan(""), 0.5}));
}

TEST(FreeSpace, ASegmentThroughACornerNeedsAllCellsAroundIt) {
  maps::OccupancyGrid grid = grid_of({"..", ".."}, 1.0);
  maps::Costmap costmap(grid.geometry);
  costmap.at({1, 0}) = maps::Costmap::kLethal;
  const FreeSpace space(grid, costmap, 0.1);
  EXPECT_FALSE(space.is_passable({0.5, 0.5}, {1.5, 1.5}));
  EXPECT_FALSE(space.is_passable({0.5, 0.4}, {1.5, 1.5}));
  EXPECT_TRUE(space.is_passable({0.5, 0.6}, {1.4, 1.5}));
}

TEST(FreeSpace, CostIsLengthOnFreeGroundAndMoreOnSoftCosts) {
  maps::OccupancyGrid grid = grid_of({"....", "...."}, 1.0);
  maps::Costmap costmap(grid.geometry);
  costmap.at({2, 0}) = costmap.at({3, 0}) = maps::Costmap::kMaxSoft;
  const FreeSpace space(grid, costmap, 0.1);
  EXPECT_NEAR(space.cost({0.0, 0.5}, {2.0, 0.5}, 3.0), 2.0, 1e-12);
  EXPECT_NEAR(space.cost({0.0, 0.5}, {4.0, 0.5}, 3.0), 2.0 + 2.0 * 4.0, 1e-12);
  EXPECT_NEAR(space.cost({0.0, 0.5}, {4.0, 0.5}, 0.0), 4.0, 1e-12);
}

TEST(FreeSpace, SlopePointsAwayFromTheNearestObstacle) {
  auto grid = grid_of(std::vector<std::string>(40, std::string(40, '.')), 0.05);
  fill(grid, 0.0, 0.0, 0.2, 2.0);
  const World world(grid, 0.3);
  const auto slope = world.space.slope({0.9, 1.0});
  EXPECT_NEAR(slope.room_m, 0.9 - 0.2 - 0.3, 1e-3);
  EXPECT_NEAR(slope.gradient.x, 1.0, 1e-3);
  EXPECT_NEAR(slope.gradient.y, 0.0, 1e-3);
}

TEST(FreeSpace, LeadsRoundACornerThatAChordScrapes) {
  auto grid = grid_of(std::vector<std::string>(60, std::string(60, '.')), 0.05);
  fill(grid, 1.0, 0.0, 3.0, 1.5);        // its corner is at (1.0, 1.5)
  maps::Costmap costmap(grid.geometry);  // nothing lethal: only the exact clearance counts
  const FreeSpace space(grid, costmap, 0.3);
  const double s = 0.3 * std::sqrt(0.5) + 1e-4;
  const TPoint2D a{1.0 - s - 0.02, 1.5 + s - 0.021};
  const TPoint2D b{1.0 - s + 0.021, 1.5 + s + 0.02};
  ASSERT_TRUE(space.is_free(a));
  ASSERT_TRUE(space.is_free(b));
  ASSERT_FALSE(space.is_free(a, b)) << "the chord no longer scrapes the corner";
  const auto way = space.way_round(a, b);
  ASSERT_TRUE(way.has_value());
  Path path{{a}};
  path.points.insert(path.points.end(), way->begin(), way->end());
  path.points.push_back(b);
  EXPECT_TRUE(is_free(space, path));
  EXPECT_LT(length_m(path), 1.05 * maps::distance(a, b));
}

}  // namespace
}  // namespace rovigo::planning
