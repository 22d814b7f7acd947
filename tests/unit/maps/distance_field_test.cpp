#include "maps/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

OccupancyGrid one_obstacle() {
  OccupancyGrid grid({0.1, {-1.0, -2.0}, 20, 30}, OccupancyGrid::kFree);
  grid.at({10, 15}) = OccupancyGrid::kOccupied;  // covers x 0.0 .. 0.1, y -0.5 .. -0.4
  return grid;
}

TEST(DistanceField, ToPointsIsToTheCellsTheyLieIn) {
  const OccupancyGrid grid = one_obstacle();
  const TPoint2D inside{0.03, -0.42}, outside{9.0, 9.0}, no_number{NAN, 0.0};
  EXPECT_EQ(distance_to_points(grid.geometry, {inside, outside, no_number}).meters,
            distance_to_occupied(grid).meters);
}

TEST(DistanceField, ReachesToCellEdges) {
  const OccupancyGrid grid = one_obstacle();
  const DistanceField field = distance_to_occupied(grid);
  EXPECT_FLOAT_EQ(field.at({10, 15}), 0.0F);
  EXPECT_FLOAT_EQ(field.at({11, 15}), 0.05F);
  EXPECT_FLOAT_EQ(field.at({10, 13}), 0.15F);
  EXPECT_FLOAT_EQ(field.at({7, 19}), static_cast<float>(std::hypot(0.25, 0.35)));
}

TEST(DistanceField, IsInfiniteWithoutObstacles) {
  const DistanceField field = distance_to_occupied(OccupancyGrid({0.1, {}, 4, 3}, 0));
  for (const float d : field.meters) EXPECT_EQ(d, std::numeric_limits<float>::infinity());
}

TEST(DistanceField, UnknownAndNearlyOccupiedCellsAreNoObstacles) {
  OccupancyGrid grid({0.1, {}, 3, 1}, OccupancyGrid::kUnknown);
  grid.at({1, 0}) = OccupancyGrid::kOccupiedThreshold - 1;
  EXPECT_TRUE(std::isinf(distance_to_occupied(grid).at({0, 0})));
}

TEST(DistanceField, GridTooWideIsRefused) {
  const OccupancyGrid grid({0.1, {}, kMaxGridSide + 1, 1}, OccupancyGrid::kFree);
  EXPECT_THROW(distance_to_occupied(grid), InputError);
}

TEST(Clearance, IsExactBetweenCellCentres) {
  const OccupancyGrid grid = one_obstacle();
  const DistanceField field = distance_to_occupied(grid);
  EXPECT_NEAR(clearance_at(grid, field, {0.13, -0.45}, 5.0), 0.03, 1e-12);
  EXPECT_NEAR(clearance_at(grid, field, {0.40, -0.80}, 5.0), std::hypot(0.3, 0.3), 1e-12);
  EXPECT_EQ(clearance_at(grid, field, {0.05, -0.45}, 5.0), 0.0);
}

TEST(Clearance, LooksNoFurtherThanTheLimit) {
  const OccupancyGrid grid = one_obstacle();
  const DistanceField field = distance_to_occupied(grid);
  EXPECT_EQ(clearance_at(grid, field, {-0.9, -1.9}, 0.5), 0.5);
}

TEST(Clearance, WorksOutsideTheGridAndWithoutObstacles) {
  const OccupancyGrid grid = one_obstacle();
  const DistanceField field = distance_to_occupied(grid);
  EXPECT_NEAR(clearance_at(grid, field, {-2.0, -0.45}, 5.0), 2.0, 1e-12);
  EXPECT_NEAR(clearance_at(grid, field, {0.05, 7.6}, 50.0), 8.0, 1e-12);
  const OccupancyGrid open({0.1, {}, 4, 3}, OccupancyGrid::kFree);
  EXPECT_EQ(clearance_at(open, distance_to_occupied(open), {0.1, 0.1}, 2.0), 2.0);
}

TEST(Clearance, PointThatIsNoNumberHasNone) {
  const OccupancyGrid grid = one_obstacle();
  EXPECT_EQ(clearance_at(grid, distance_to_occupied(grid), {NAN, 0.0}, 2.0), 0.0);
}

}  // namespace
}  // namespace rovigo::maps
