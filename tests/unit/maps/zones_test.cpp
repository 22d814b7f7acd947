#include "maps/zones.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/error.h"
#include "maps/inflation.h"

namespace rovigo::maps {
namespace {

const GridGeometry kTenByTen{0.1, {0.0, 0.0}, 10, 10};

int occupied(const OccupancyGrid& grid) {
  return static_cast<int>(
      std::count(grid.cells.begin(), grid.cells.end(), OccupancyGrid::kOccupied));
}

TEST(Zones, RectangleCoversEveryCellItTouches) {
  const auto mask =
      keepout_mask(kTenByTen, {{"a", {{0.25, 0.35}, {0.45, 0.35}, {0.45, 0.62}, {0.25, 0.62}}}});
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      const bool inside = x >= 2 && x <= 4 && y >= 3 && y <= 6;
      EXPECT_EQ(OccupancyGrid::is_occupied(mask.at({x, y})), inside) << x << ", " << y;
    }
  }
}

TEST(Zones, OrderOfCornersDoesNotMatter) {
  const NoGoZone one{"a", {{0.1, 0.1}, {0.8, 0.2}, {0.5, 0.9}}};
  const NoGoZone other{"a", {{0.5, 0.9}, {0.8, 0.2}, {0.1, 0.1}}};
  EXPECT_EQ(keepout_mask(kTenByTen, {one}).cells, keepout_mask(kTenByTen, {other}).cells);
}

TEST(Zones, ThinSliverBetweenCentresStillBlocks) {
  // 2 mm wide, through no cell centre: sampling centres alone would miss it.
  const auto mask =
      keepout_mask(kTenByTen, {{"s", {{0.42, 0.0}, {0.422, 0.0}, {0.422, 1.0}, {0.42, 1.0}}}});
  for (int y = 0; y < 10; ++y) EXPECT_TRUE(OccupancyGrid::is_occupied(mask.at({4, y})));
  EXPECT_EQ(occupied(mask), 10);
}

TEST(Zones, PointAndLineBlockToo) {
  EXPECT_EQ(occupied(keepout_mask(kTenByTen, {{"p", {{0.55, 0.55}}}})), 1);
  EXPECT_EQ(occupied(keepout_mask(kTenByTen, {{"l", {{0.05, 0.55}, {0.95, 0.55}}}})), 10);
  EXPECT_EQ(occupied(keepout_mask(kTenByTen, {{"none", {}}})), 0);
}

TEST(Zones, ReachingFarOutsideTheGridIsFine) {
  const double far = 1e12;
  const auto mask =
      keepout_mask(kTenByTen, {{"all", {{-far, -far}, {far, -far}, {far, far}, {-far, far}}}});
  EXPECT_EQ(occupied(mask), 100);
  EXPECT_EQ(occupied(keepout_mask(kTenByTen, {{"out", {{5, 5}, {6, 5}, {6, 6}}}})), 0);
}

TEST(Zones, CornerThatIsNoNumberIsRefused) {
  EXPECT_THROW(keepout_mask(kTenByTen, {{"bad", {{NAN, 0.0}}}}), InputError);
}

TEST(Zones, KeepTheRobotsRadiusAwayLikeWalls) {
  OccupancyGrid grid(GridGeometry{0.05, {0.0, 0.0}, 60, 60}, OccupancyGrid::kFree);
  apply_zones(grid, {{"z", {{1.4, 1.4}, {1.6, 1.4}, {1.6, 1.6}, {1.4, 1.6}}}});
  const Costmap costs = inflate_safe(grid, {.robot_radius_m = 0.3, .soft_cost_sigma_m = 0.0});
  EXPECT_EQ(costs.at(costs.geometry.cell_at({1.87, 1.5})), Costmap::kLethal);
  EXPECT_EQ(costs.at(costs.geometry.cell_at({2.02, 1.5})), Costmap::kFree);
}

TEST(Zones, UnknownGroundUnderAZoneIsBlockedInEveryMode) {
  OccupancyGrid grid(kTenByTen, OccupancyGrid::kUnknown);
  apply_zones(grid, {{"z", {{0.3, 0.3}, {0.6, 0.3}, {0.6, 0.6}}}});
  const Costmap costs = inflate_safe(
      grid,
      {.robot_radius_m = 0.0, .soft_cost_sigma_m = 0.0, .map_mode = MapMode::kUnknownPassable});
  EXPECT_EQ(costs.at({5, 4}), Costmap::kLethal);
  EXPECT_EQ(costs.at({0, 0}), Costmap::kFree);
}

}  // namespace
}  // namespace rovigo::maps
