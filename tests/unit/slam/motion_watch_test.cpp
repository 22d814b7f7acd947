#include "slam/motion_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/surroundings.h"
#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

constexpr double kCameraHeightM = 0.25;

Se3 base_from_camera() { return test::looking_ahead(kCameraHeightM); }

/// Something 0.4 m wide and as tall as a person, with its front at `x`.
struct Body {
  double x = 0, y = 0;
};

/// What a camera at the origin that looks along x sees: floor, a wall at `wall_m` (0: none within
/// range), and bodies.
cv::Mat view_of(double wall_m, const std::vector<Body>& bodies) {
  const CameraModel camera(test::pinhole(290, 320, 240));
  cv::Mat depth(camera.height(), camera.width(), CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d d =
          base_from_camera().rotation * camera.unproject(Eigen::Vector2d(u, v), 1.0);
      double z = wall_m > 0 ? wall_m : 100.0;
      if (d.z() < 0) z = std::min(z, -kCameraHeightM / d.z());
      for (const Body& b : bodies) {
        if (std::abs(b.x * d.y() - b.y) < 0.2) z = std::min(z, b.x);
      }
      if (z < 6.0) depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1000 * z);
    }
  }
  return depth;
}

/// A rover that rests at the map's origin and watches.
class MotionWatchTest : public testing::Test {
 protected:
  MotionWatchTest()
      : camera_(test::pinhole(290, 320, 240)),
        map_(config_, camera_, base_from_camera()),
        scanner_(camera_, config_.depth),
        watch_(camera_, config_.depth) {
    map_.add_keyframe(Keyframe{});
  }

  static AnchoredView view_at(double time_s) { return {time_s, 0, Se3{}, base_from_camera()}; }
  void see(double time_s, const cv::Mat& depth) { watch_.remember(depth, 0.001, view_at(time_s)); }

  /// Shares of the rays ending on the body, and elsewhere higher than the floor, that move.
  struct Shares {
    double of_body = 0, of_others = 0;
  };
  Shares marked(double time_s, const cv::Mat& depth, const Body& body) {
    DepthScan scan = scanner_.scan(depth, 0.001, base_from_camera());
    watch_.mark_moving(view_at(time_s), map_, scan);
    int on = 0, on_moving = 0, off = 0, off_moving = 0;
    for (const ScanRay& r : scan.rays) {
      const double x = r.range_m * r.along_x, y = r.range_m * r.along_y;
      if (kCameraHeightM + r.slope * r.range_m < 0.05) continue;
      const bool on_body =
          std::abs(x - body.x) < 0.02 && std::abs(y - body.y) < 0.25;  // with its edges
      (on_body ? on : off) += 1;
      (on_body ? on_moving : off_moving) += r.moving ? 1 : 0;
    }
    return {static_cast<double>(on_moving) / on, off ? static_cast<double>(off_moving) / off : 0.0};
  }

  SlamConfig config_;
  CameraModel camera_;
  LandmarkMap map_;
  DepthScanner scanner_;
  MotionWatch watch_;
};

TEST_F(MotionWatchTest, WhoComesAndGoesIsMovingAndTheWallBehindIsNot) {
  const Body body{2.0, 0.1};
  see(0.0, view_of(4.0, {}));
  see(0.4, view_of(4.0, {body}));
  see(0.8, view_of(4.0, {{2.0, 1.0}}));
  const Shares s = marked(0.4, view_of(4.0, {body}), body);
  EXPECT_GT(s.of_body, 0.99);
  EXPECT_EQ(s.of_others, 0.0);
}

TEST_F(MotionWatchTest, WhatStaysStaysWhileSomebodyPassesFartherOff) {
  const Body chair{2.0, 0.6};
  for (int i = 0; i < 4; ++i) see(0.35 * i, view_of(4.0, {chair, {2.0, -0.9 + 0.2 * i}}));
  EXPECT_EQ(marked(0.7, view_of(4.0, {chair, {2.0, -0.5}}), chair).of_body, 0.0);
}

TEST_F(MotionWatchTest, OpenGroundBeyondTheRangeTellsWhoLeft) {
  const Body body{2.5, -0.3};
  see(0.0, view_of(0.0, {body}));
  see(0.5, view_of(0.0, {{2.5, 0.4}}));
  EXPECT_GT(marked(0.0, view_of(0.0, {body}), body).of_body, 0.99);
}

TEST_F(MotionWatchTest, ACoveredCameraMovesNothing) {
  const Body body{2.0, 0.0};
  see(0.0, view_of(4.0, {body}));
  see(0.4, cv::Mat::zeros(240, 320, CV_16UC1));
  EXPECT_EQ(marked(0.0, view_of(4.0, {body}), body).of_body, 0.0);
}

TEST_F(MotionWatchTest, ARoverThatTurnsDoesNotTakeTheWorldForMoving) {
  // The view from a pose turned by 0.1 rad onto the same wall is told as such by the anchor.
  const double turn = 0.1;
  Se3 turned;
  turned.rotation = so3_exp({0, 0, turn});
  cv::Mat oblique(240, 320, CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d d = turned.rotation * base_from_camera().rotation *
                                camera_.unproject(Eigen::Vector2d(u, v), 1.0);
      double z = 3.0 / d.x();
      if (d.z() < 0) z = std::min(z, -kCameraHeightM / d.z());
      oblique.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1000 * z);
    }
  }
  watch_.remember(oblique, 0.001, {0.4, 0, turned, base_from_camera()});
  const Shares s = marked(0.0, view_of(3.0, {}), {3.0, 0.0});
  EXPECT_EQ(s.of_body, 0.0);
  EXPECT_EQ(s.of_others, 0.0);
}

/// Occupied cells nearer than the wall.
int occupied_before(const maps::OccupancyGrid& grid, double x_m) {
  int n = 0;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    n += maps::OccupancyGrid::is_occupied(grid.cells[i]) &&
         grid.geometry.center_of(grid.geometry.cell_of(i)).x < x_m;
  }
  return n;
}

class SurroundingsTest : public MotionWatchTest {
 protected:
  SurroundingsTest() : surroundings_(config_, camera_, base_from_camera(), true) {}

  /// The rover creeps ahead by 6 cm a look, so little that the drawn view stays right to a cell.
  void look(double time_s, const cv::Mat& depth, int keyframe = 0) {
    CameraFrame frame;
    frame.time_s = time_s;
    frame.depth = depth;
    Se3 pose = map_.keyframe(keyframe).map_from_base;
    pose.translation.x() += (looks_++ % 2) * 0.065;
    surroundings_.look(frame, map_, keyframe, pose);
  }

  Surroundings surroundings_;
  int looks_ = 0;
};

TEST_F(SurroundingsTest, WhoStoodInTheLastViewBeforeTheRoverTurnedAwayIsNoObstacle) {
  look(0.0, view_of(4.0, {}));
  look(0.4, view_of(4.0, {{2.0, 0.9}}));
  for (int i = 0; i < 3; ++i) look(0.6 + 0.1 * i, view_of(4.0, {{2.0, 0.0}}));
  const maps::OccupancyGrid grid = surroundings_.render(map_);
  EXPECT_EQ(occupied_before(grid, 3.5), 0);
  EXPECT_GT(occupied_before(grid, 5.0), 10);  // the wall is there
}

TEST_F(SurroundingsTest, WhatStoodThereAllAlongIsAnObstacle) {
  for (int i = 0; i < 8; ++i) look(0.2 * i, view_of(4.0, {{2.0, 0.0}}));
  EXPECT_GT(occupied_before(surroundings_.render(map_), 3.5), 5);
}

TEST_F(SurroundingsTest, MemoryStaysWhenTheSamePlaceIsSeenAgain) {
  for (int i = 0; i < 20; ++i) look(0.2 * i, view_of(4.0, {}));
  const std::size_t once = surroundings_.memory_bytes();
  for (int i = 20; i < 80; ++i) look(0.2 * i, view_of(4.0, {}));
  EXPECT_LE(surroundings_.memory_bytes(), once + once / 20);
}

}  // namespace
}  // namespace rovigo::slam
