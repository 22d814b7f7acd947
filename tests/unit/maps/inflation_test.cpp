#include "maps/inflation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

OccupancyGrid free_grid(int width, int height, double resolution_m = 0.05) {
  return OccupancyGrid({resolution_m, {0.0, 0.0}, width, height}, OccupancyGrid::kFree);
}

TEST(SafeInflation, LonePoleGrowsByTheRadiusFromItsEdge) {
  OccupancyGrid grid = free_grid(41, 41);
  grid.at({20, 20}) = OccupancyGrid::kOccupied;
  const Costmap map = inflate_safe(grid, {.robot_radius_m = 0.30, .soft_cost_sigma_m = 0.0});
  // Six cells away the gap to the edge is 5.5 cells, 0.275 m; seven away 6.5 cells, 0.325 m.
  EXPECT_EQ(map.at({26, 20}), Costmap::kLethal);
  EXPECT_EQ(map.at({27, 20}), Costmap::kFree);
  // On the diagonal: 4.5 sqrt(2) cells are 0.318 m, 3.5 sqrt(2) cells 0.247 m.
  EXPECT_EQ(map.at({24, 24}), Costmap::kLethal);
  EXPECT_EQ(map.at({25, 25}), Costmap::kFree);
}

TEST(SafeInflation, DistanceEqualToTheRadiusIsAllowed) {
  OccupancyGrid grid = free_grid(41, 3);
  grid.at({0, 1}) = OccupancyGrid::kOccupied;
  const Costmap map = inflate_safe(grid, {.robot_radius_m = 0.275, .soft_cost_sigma_m = 0.0});
  EXPECT_EQ(map.at({5, 1}), Costmap::kLethal);
  EXPECT_EQ(map.at({6, 1}), Costmap::kFree);  // 5.5 cells = 0.275 m
}

TEST(SafeInflation, SoftCostIsAGaussianOfTheDistanceBeyondTheRadius) {
  OccupancyGrid grid = free_grid(60, 1);
  grid.at({0, 0}) = OccupancyGrid::kOccupied;
  const InflationConfig config{
      .robot_radius_m = 0.2, .soft_cost_sigma_m = 0.3, .soft_cost_peak = 250};
  const Costmap map = inflate_safe(grid, config);
  for (int x = 1; x < 60; ++x) {
    const double distance_m = (x - 0.5) * 0.05;
    if (distance_m < 0.2) {
      EXPECT_EQ(map.at({x, 0}), Costmap::kLethal);
    } else {
      const double sigmas = (distance_m - 0.2) / 0.3;
      EXPECT_EQ(map.at({x, 0}), std::lround(250 * std::exp(-0.5 * sigmas * sigmas))) << x;
    }
  }
}

TEST(SafeInflation, MapModesTreatUnknownGround) {
  OccupancyGrid grid = free_grid(30, 1);
  grid.at({0, 0}) = OccupancyGrid::kOccupied;
  grid.at({1, 0}) = OccupancyGrid::kUnknown;
  grid.at({29, 0}) = OccupancyGrid::kUnknown;
  InflationConfig config{.robot_radius_m = 0.1, .soft_cost_sigma_m = 0.0};
  const Costmap known = inflate_safe(grid, config);
  EXPECT_EQ(known.at({1, 0}), Costmap::kLethal);
  EXPECT_EQ(known.at({29, 0}), Costmap::kUnknown);
  EXPECT_FALSE(known.is_passable(Cell{29, 0}));
  EXPECT_EQ(known.at({28, 0}), Costmap::kFree) << "unknown cells do not grow";
  config.map_mode = MapMode::kUnknownPassable;
  EXPECT_EQ(inflate_safe(grid, config).at({29, 0}), Costmap::kFree);
  config.map_mode = MapMode::kEverything;
  EXPECT_EQ(inflate_safe(grid, config).at({0, 0}), Costmap::kFree);
}

TEST(SafeInflation, ZeroRadiusLeavesOnlyOccupiedCells) {
  OccupancyGrid grid = free_grid(5, 5);
  grid.at({2, 2}) = OccupancyGrid::kOccupied;
  const Costmap map = inflate_safe(grid, {.robot_radius_m = 0.0, .soft_cost_sigma_m = 0.0});
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    EXPECT_EQ(map.cells[i], i == 12 ? Costmap::kLethal : Costmap::kFree);
  }
}

TEST(SafeInflation, VeryLargeRadiusInFineCellsStillWorks) {
  OccupancyGrid grid = free_grid(3000, 1, 0.001);
  grid.at({0, 0}) = OccupancyGrid::kOccupied;
  const Costmap map = inflate_safe(grid, {.robot_radius_m = 2.0, .soft_cost_sigma_m = 0.5});
  EXPECT_EQ(map.at({2000, 0}), Costmap::kLethal);
  EXPECT_EQ(map.at({2001, 0}), 200);
}

TEST(SafeInflation, SettingsOutOfRangeAreRefused) {
  const OccupancyGrid grid = free_grid(3, 3);
  EXPECT_THROW(inflate_safe(grid, {.robot_radius_m = -0.1}), InputError);
  EXPECT_THROW(inflate_safe(grid, {.robot_radius_m = NAN}), InputError);
  EXPECT_THROW(inflate_safe(grid, {.soft_cost_sigma_m = INFINITY}), InputError);
  EXPECT_THROW(inflate_safe(grid, {.soft_cost_peak = 253}), InputError);
  EXPECT_THROW(inflate_reference(grid, -1.0, MapMode::kKnownFree), InputError);
  EXPECT_THROW(inflate_reference(grid, NAN, MapMode::kKnownFree), InputError);
}

TEST(SafeInflation, EmptyGridGivesAnEmptyCostmap) {
  EXPECT_TRUE(inflate_safe(OccupancyGrid{}, {}).cells.empty());
  EXPECT_TRUE(inflate_reference(OccupancyGrid{}, 2.0, MapMode::kKnownFree).cells.empty());
}

TEST(ReferenceInflation, FollowsTheThreeMapModes) {
  OccupancyGrid grid = free_grid(60, 20);
  grid.at({10, 10}) = OccupancyGrid::kOccupied;
  grid.at({45, 10}) = OccupancyGrid::kUnknown;
  const Costmap known = inflate_reference(grid, 2.0, MapMode::kKnownFree);
  EXPECT_EQ(known.at({13, 10}), Costmap::kLethal);
  EXPECT_EQ(known.at({14, 10}), Costmap::kFree);
  EXPECT_EQ(known.at({48, 10}), Costmap::kLethal) << "unknown is blurred like an obstacle";
  const Costmap unknown_too = inflate_reference(grid, 2.0, MapMode::kUnknownPassable);
  EXPECT_EQ(unknown_too.at({13, 10}), Costmap::kLethal);
  EXPECT_EQ(unknown_too.at({45, 10}), Costmap::kFree);
  const Costmap everything = inflate_reference(grid, 2.0, MapMode::kEverything);
  EXPECT_EQ(everything.at({10, 10}), Costmap::kFree);
}

TEST(ReferenceInflation, SigmaZeroIsOff) {
  OccupancyGrid grid = free_grid(5, 5);
  grid.at({2, 2}) = OccupancyGrid::kOccupied;
  const Costmap map = inflate_reference(grid, 0.0, MapMode::kKnownFree);
  EXPECT_EQ(map.at({2, 2}), Costmap::kLethal);
  EXPECT_EQ(map.at({2, 3}), Costmap::kFree);
}

TEST(InflationSettings, RangesAreChecked) {
  EXPECT_NO_THROW(validate(InflationConfig{}));
  EXPECT_THROW(validate(InflationConfig{.soft_cost_peak = 900}), InputError);
  EXPECT_THROW(validate(InflationConfig{.map_mode = static_cast<MapMode>(3)}), InputError);
}

}  // namespace
}  // namespace rovigo::maps
