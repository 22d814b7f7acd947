#include "slam/localizer_depth_check.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/support/landmark_room.h"

namespace rovigo::slam {
namespace {

using namespace test;

/// Free ground around the landmark room, with a wall across at `wall_x_m` if that is given.
maps::OccupancyGrid grid_with_wall(std::optional<double> wall_x_m) {
  maps::OccupancyGrid grid;
  grid.geometry = {0.05, {-1.0, -3.0}, 120, 120};
  grid.cells.assign(grid.geometry.size(), maps::OccupancyGrid::kFree);
  for (double y = -2.9; wall_x_m && y < 2.9; y += 0.05) {
    grid.cells[grid.geometry.index_of(grid.geometry.cell_at({*wall_x_m, y}))] =
        maps::OccupancyGrid::kOccupied;
  }
  return grid;
}

CameraFrame facing_a_wall_at(double depth_m) {
  CameraFrame frame;
  frame.depth_unit_m = 0.001;
  frame.depth = cv::Mat(480, 640, CV_16U, cv::Scalar(1000.0 * depth_m));
  return frame;
}

struct Case {
  LandmarkMap map = room_map(Room(300), {{0, 0, 0}}, {{0, 0, 0}}, 0.0, 0.0);
  DepthAgreement judged(double depth_m, const maps::OccupancyGrid& grid) const {
    const SignedDistanceField walls(grid);
    return depth_agreement(map, map.landmarks_of({0}), facing_a_wall_at(depth_m), Se3{}, true,
                           &walls);
  }
};

TEST(LocalizerDepthCheck, WhatTheMapHasBehindAWallIsNotExpectedToBeSeen) {
  const DepthAgreement seen = Case().judged(1.4, grid_with_wall(1.5));
  EXPECT_EQ(seen.hidden, 0);
  EXPECT_EQ(seen.share(), 1.0);
}

TEST(LocalizerDepthCheck, AWallThatTheMapDoesNotHaveContradicts) {
  const DepthAgreement seen = Case().judged(1.4, grid_with_wall(std::nullopt));
  EXPECT_GT(seen.hidden, 50);
  EXPECT_LT(seen.share(), 0.1);
}

TEST(LocalizerDepthCheck, TheWallThatLandmarksAreOnDoesNotHideThem) {
  const DepthAgreement seen = Case().judged(1.4, grid_with_wall(3.0));
  EXPECT_GT(seen.hidden, 50);
}

}  // namespace
}  // namespace rovigo::slam
