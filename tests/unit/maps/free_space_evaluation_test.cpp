#include "maps/free_space_evaluation.h"

#include <gtest/gtest.h>

namespace rovigo::maps {
namespace {

/// A corridor along x, 4 m by 1 m, closed by a wall at its end; beyond the wall a free room.
OccupancyGrid corridor() {
  GridGeometry g;
  g.resolution_m = 0.1;
  g.width = 60;
  g.height = 10;
  OccupancyGrid grid(g);
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      grid.at({x, y}) = x == 40 ? OccupancyGrid::kOccupied : OccupancyGrid::kFree;
    }
  }
  return grid;
}

const FieldOfView kField{.left_rad = 0.5, .right_rad = 0.5, .range_m = 6.0, .floor_range_m = 1.0};

TEST(FreeSpaceEvaluation, WhatLiesBehindAWallOrBesideTheViewIsNotInView) {
  const OccupancyGrid truth = corridor();
  const auto seen = cells_in_view(truth, {{TPose2D(1.05, 0.55, 0.0)}}, kField);
  EXPECT_TRUE(seen[truth.geometry.index_of({30, 5})]);
  EXPECT_FALSE(seen[truth.geometry.index_of({50, 5})]);
  EXPECT_FALSE(seen[truth.geometry.index_of({5, 5})]);
  EXPECT_FALSE(seen[truth.geometry.index_of({11, 9})]);
}

TEST(FreeSpaceEvaluation, WithoutAReturnOnlyTheFloorNearbyIsKnown) {
  const OccupancyGrid truth = corridor();
  FieldOfView shortsighted = kField;
  shortsighted.range_m = 2.0;
  const auto seen = cells_in_view(truth, {{TPose2D(1.05, 0.55, 0.0)}}, shortsighted);
  EXPECT_TRUE(seen[truth.geometry.index_of({18, 5})]);
  EXPECT_FALSE(seen[truth.geometry.index_of({25, 5})]);
  // A camera so high that it would see floor beyond its range does not.
  shortsighted.floor_range_m = 50.0;
  const auto high = cells_in_view(truth, {{TPose2D(1.05, 0.55, 0.0)}}, shortsighted);
  EXPECT_FALSE(high[truth.geometry.index_of({35, 5})]);
  EXPECT_FALSE(high[0]);
}

TEST(FreeSpaceEvaluation, BeforeALowTableTheGroundIsToldOnlyWhereSomethingTallStandsBehind) {
  const OccupancyGrid tall = corridor();
  OccupancyGrid truth = tall;
  for (int y = 0; y < 10; ++y) truth.at({30, y}) = OccupancyGrid::kOccupied;
  FieldOfView field = kField;
  const std::vector<View> views{{TPose2D(1.05, 0.55, 0.0)}};
  const auto walled = cells_in_view(truth, tall, views, field);
  EXPECT_TRUE(walled[truth.geometry.index_of({25, 5})]);
  EXPECT_FALSE(walled[truth.geometry.index_of({35, 5})]);  // hidden by the table
  field.range_m = 2.5;
  const auto open = cells_in_view(truth, tall, views, field);
  EXPECT_FALSE(open[truth.geometry.index_of({25, 5})]);
  EXPECT_TRUE(open[truth.geometry.index_of({15, 5})]);
  EXPECT_TRUE(cells_in_view(truth, views, field)[truth.geometry.index_of({25, 5})]);
}

TEST(FreeSpaceEvaluation, RoomsNeverSeenAreNotAskedForButWhatIsClaimedThereIsJudged) {
  const OccupancyGrid truth = corridor();
  const auto seen = cells_in_view(truth, {{TPose2D(1.05, 0.55, 0.0)}}, kField);
  OccupancyGrid map(truth.geometry);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i]) map.cells[i] = OccupancyGrid::kFree;
  }
  EXPECT_EQ(free_iou_in_view(map, truth, {}, seen), 1.0);
  OccupancyGrid walks_through_walls = map;
  for (int y = 0; y < 10; ++y) walks_through_walls.at({40, y}) = OccupancyGrid::kFree;
  EXPECT_LT(*free_iou_in_view(walks_through_walls, truth, {}, seen), 0.97);
  OccupancyGrid half = map;
  for (std::size_t i = 0; i < seen.size(); i += 2) half.cells[i] = OccupancyGrid::kUnknown;
  EXPECT_NEAR(*free_iou_in_view(half, truth, {}, seen), 0.5, 0.05);
  const OccupancyGrid nothing(truth.geometry);
  EXPECT_FALSE(free_iou_in_view(nothing, truth, {}, std::vector<bool>(seen.size(), false)));
}

}  // namespace
}  // namespace rovigo::maps
