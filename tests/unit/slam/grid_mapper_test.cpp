#include "slam/grid_mapper.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::slam {
namespace {

constexpr double kCameraHeightM = 0.25;

mrpt::img::TCamera intrinsics() {
  mrpt::img::TCamera c;
  c.ncols = 640;
  c.nrows = 480;
  c.setIntrinsicParamsFromValues(460, 460, 319.5, 239.5);
  return c;
}

Se3 level_camera() {
  Se3 s;
  s.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  s.translation = {0.0, 0.0, kCameraHeightM};
  return s;
}

/// Depth of a wall across the view at `wall_m`, between two heights, over a floor; what is above
/// the wall shows a second wall far behind.
cv::Mat view(const CameraModel& camera, double wall_m, double low_m, double high_m, double far_m) {
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const double down = camera.unproject({u, v}, 1.0).y();
      const double at_wall = kCameraHeightM - down * wall_m;
      double z = far_m;
      if (down > 0) z = std::min(z, kCameraHeightM / down);  // floor
      if (at_wall >= low_m && at_wall <= high_m) z = std::min(z, wall_m);
      depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(1000 * z));
    }
  }
  return depth;
}

class Scanning : public ::testing::Test {
 protected:
  DepthScan scan(double wall_m, double low_m, double high_m, double far_m) {
    return scanner_.scan(view(camera_, wall_m, low_m, high_m, far_m), 0.001, level_camera());
  }
  maps::OccupancyGrid grid_of(const DepthScan& scan, int times) {
    GridRequest request;
    for (int i = 0; i < times; ++i) request.scans.push_back({{0, 0, 0}, &scan});
    return render_grid(request, config_);
  }
  static std::int8_t value(const maps::OccupancyGrid& g, double x, double y) {
    const maps::Cell c = g.geometry.cell_at({x, y});
    return g.geometry.contains(c) ? g.at(c) : maps::OccupancyGrid::kUnknown;
  }

  CameraModel camera_{intrinsics()};
  GridConfig config_;
  DepthScanner scanner_{camera_, config_, DepthConfig{}};
};

TEST_F(Scanning, AWallIsAnObstacleAndTheGroundBeforeItIsFree) {
  const DepthScan s = scan(2.0, 0.0, 2.0, 5.0);
  const auto g = grid_of(s, 5);
  EXPECT_TRUE(maps::OccupancyGrid::is_occupied(value(g, 2.02, 0.0)));
  EXPECT_TRUE(maps::OccupancyGrid::is_free(value(g, 1.0, 0.0)));
  EXPECT_TRUE(maps::OccupancyGrid::is_unknown(value(g, 2.5, 0.0))) << "behind the wall";
}

TEST_F(Scanning, TheFloorAloneIsNoObstacle) {
  const DepthScan s = scan(10.0, 0.0, 0.0, 5.9);
  EXPECT_TRUE(s.hits.empty());
  EXPECT_TRUE(maps::OccupancyGrid::is_free(value(grid_of(s, 5), 2.0, 0.0)));
}

TEST_F(Scanning, ADoorSillBelowTheObstacleHeightIsFloor) {
  EXPECT_TRUE(scan(1.5, 0.0, 0.03, 5.9).hits.empty());
}

TEST_F(Scanning, ATopThatCanBeDrivenUnderIsIgnoredAndClearedBelow) {
  const DepthScan s = scan(2.0, 0.70, 0.80, 4.0);  // a desk top and a wall behind it
  const auto g = grid_of(s, 5);
  EXPECT_TRUE(maps::OccupancyGrid::is_free(value(g, 2.02, 0.0)));
  EXPECT_TRUE(maps::OccupancyGrid::is_occupied(value(g, 4.02, 0.0)));
}

TEST_F(Scanning, ALowBoxStaysThoughRaysPassOverIt) {
  const DepthScan s = scan(1.5, 0.0, 0.15, 4.0);
  const auto g = grid_of(s, 20);
  EXPECT_TRUE(maps::OccupancyGrid::is_occupied(value(g, 1.52, 0.0)));
  EXPECT_TRUE(maps::OccupancyGrid::is_occupied(value(g, 4.02, 0.0)));
}

TEST_F(Scanning, SomethingThatLeftIsCleared) {
  const DepthScan with = scan(1.5, 0.0, 2.0, 4.0);
  const DepthScan without = scan(10.0, 0.0, 0.0, 4.0);
  GridRequest request;
  for (int i = 0; i < 3; ++i) request.scans.push_back({{0, 0, 0}, &with});
  for (int i = 0; i < 20; ++i) request.scans.push_back({{0, 0, 0}, &without});
  EXPECT_TRUE(maps::OccupancyGrid::is_free(value(render_grid(request, config_), 1.52, 0.0)));
}

TEST_F(Scanning, AnImageWithoutReturnsSaysNothing) {
  const cv::Mat nothing(480, 640, CV_16UC1, cv::Scalar(0));
  const DepthScan s = scanner_.scan(nothing, 0.001, level_camera());
  EXPECT_TRUE(s.hits.empty());
  const auto g = grid_of(s, 3);
  for (const auto cell : g.cells) EXPECT_EQ(cell, maps::OccupancyGrid::kUnknown);
}

TEST_F(Scanning, WhereTheRoverWasIsFree) {
  GridRequest request;
  request.driven = {{1.0, 1.0, 0.0}, {1.0, 1.0, 0.0}};
  request.driven_radius_m = 0.2;
  const auto g = render_grid(request, config_);
  EXPECT_TRUE(maps::OccupancyGrid::is_free(value(g, 1.1, 1.0)));
  EXPECT_TRUE(maps::OccupancyGrid::is_unknown(value(g, 1.4, 1.0)));
}

}  // namespace
}  // namespace rovigo::slam
