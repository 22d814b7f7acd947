#include "slam/grid_match.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::slam {
namespace {

using maps::OccupancyGrid;

/// Walls so many cells thick around [0, width] x [0, height] metres, free inside.
OccupancyGrid room(double width_m, double height_m, int thick = 1) {
  const int w = static_cast<int>(std::lround(width_m / 0.05));
  const int h = static_cast<int>(std::lround(height_m / 0.05));
  OccupancyGrid grid({0.05, {-0.05 * thick, -0.05 * thick}, w + 2 * thick, h + 2 * thick},
                     OccupancyGrid::kOccupied);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) grid.at({x + thick, y + thick}) = OccupancyGrid::kFree;
  }
  return grid;
}

/// What a 70 degree camera at `pose` sees of the walls of such a room.
std::vector<ScanPoint> scan_in_room(const TPose2D& pose, double width_m, double height_m) {
  std::vector<ScanPoint> scan;
  for (int i = -60; i <= 60; ++i) {
    const double angle = pose.phi + i * 0.01;
    const double c = std::cos(angle), s = std::sin(angle);
    const double tx = c > 0 ? (width_m - pose.x) / c : c < 0 ? -pose.x / c : 1e9;
    const double ty = s > 0 ? (height_m - pose.y) / s : s < 0 ? -pose.y / s : 1e9;
    const double range = std::min(tx, ty);
    const TPoint2D hit{pose.x + range * c, pose.y + range * s};
    scan.push_back({maps::transform(maps::inverse(pose), hit), 0.01});
  }
  return scan;
}

Eigen::Matrix3d prior_covariance(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

TEST(GridMatch, AScanOfTwoWallsCorrectsAPoseThatIsOff) {
  const TPose2D truth(2.2, 1.7, 0.7);
  const TPose2D prior(2.30, 1.62, 0.74);
  const SignedDistanceField field(room(4.0, 3.0));
  const GridMatch match =
      match_scan(field, scan_in_room(truth, 4.0, 3.0), prior, prior_covariance(0.2, 0.1));
  EXPECT_NEAR(match.look.map_from_base.x, truth.x, 0.01);
  EXPECT_NEAR(match.look.map_from_base.y, truth.y, 0.01);
  EXPECT_NEAR(match.look.map_from_base.phi, truth.phi, 0.005);
  EXPECT_GT(match.inlier_share, 0.95);
}

TEST(GridMatch, ALongWallSaysNothingAboutTheWayAlongIt) {
  const SignedDistanceField field(room(40.0, 3.0));
  const TPose2D truth(20.0, 1.5, maps::kPi / 2);
  const TPose2D prior(20.3, 1.45, maps::kPi / 2);
  const GridMatch match =
      match_scan(field, scan_in_room(truth, 40.0, 3.0), prior, prior_covariance(0.2, 0.05));
  EXPECT_NEAR(match.look.map_from_base.x, prior.x, 1e-3);  // left where the wheels put it
  EXPECT_NEAR(match.look.map_from_base.y, truth.y, 0.01);
  EXPECT_LT(match.look.information(0, 0), 1e-3 * match.look.information(1, 1));
}

// A map marks the cells that surfaces lie in; their edges stand up to a cell before those.
TEST(GridMatch, SurfacesSomewhereInTheirCellsGiveNoBias) {
  const SignedDistanceField field(room(4.0, 3.0, 3));
  const double depth_m = field.mapped_surface_depth_m();
  EXPECT_DOUBLE_EQ(depth_m, 0.025);
  const TPose2D truth(2.2, 1.7, 0.7);
  // The camera meets the middles of the cells around the room, as of a room that is larger.
  TPose2D in_larger = truth;
  in_larger.x += depth_m;
  in_larger.y += depth_m;
  const auto scan = scan_in_room(in_larger, 4.0 + 2.0 * depth_m, 3.0 + 2.0 * depth_m);
  const TPose2D prior(2.24, 1.66, 0.72);
  const auto error_m = [&](double surface_depth_m) {
    const TPose2D found =
        match_scan(field, scan, prior, prior_covariance(0.2, 0.1), surface_depth_m)
            .look.map_from_base;
    return maps::distance(maps::position_of(found), maps::position_of(truth));
  };
  EXPECT_LT(error_m(depth_m), 0.01);
  EXPECT_GT(error_m(0.0), 0.02);
}

TEST(GridMatch, ADifferentRoomIsNotAgreedWith) {
  const SignedDistanceField field(room(4.0, 3.0));
  const TPose2D pose(1.0, 1.0, 0.0);
  const GridMatch match =
      match_scan(field, scan_in_room(pose, 2.5, 1.8), pose, prior_covariance(0.02, 0.01));
  EXPECT_LT(match.inlier_share, 0.5);
}

TEST(SignedDistanceField, IsNegativeInsideObstaclesAndUnknownOutside) {
  const SignedDistanceField field(room(4.0, 3.0));
  EXPECT_NEAR(field.at({2.0, 0.30}).meters, 0.30, 1e-6);
  EXPECT_LT(field.at({2.0, -0.02}).meters, 0.0);
  EXPECT_FALSE(field.at({9.0, 0.0}).known);
  EXPECT_FALSE(field.at({std::nan(""), 0.0}).known);
}

}  // namespace
}  // namespace rovigo::slam
