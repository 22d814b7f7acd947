#include "slam/view_continuity.h"

#include <gtest/gtest.h>

#include "maps/geometry.h"

namespace rovigo::slam {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kFocalPx = 280.0;

CameraModel camera() {
  mrpt::img::TCamera c;
  c.ncols = kWidth;
  c.nrows = kHeight;
  c.setIntrinsicParamsFromValues(kFocalPx, kFocalPx, kWidth / 2.0, kHeight / 2.0);
  return CameraModel(c);
}

/// The camera looks along the rover's x, level, 0.25 m above the floor.
Se3 base_from_camera() {
  Se3 pose;
  pose.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.translation = {0.0, 0.0, 0.25};
  return pose;
}

/// What the camera measures at `pose` in a room whose walls are x = 4 m, x = -2 m, y = 3 m and
/// y = -1 m, without floor or ceiling.
CameraFrame frame_in_room(double time_s, const TPose2D& pose) {
  CameraFrame frame;
  frame.time_s = time_s;
  frame.depth = cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(0));
  const Se3 map_from_camera = from_planar(pose) * base_from_camera();
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray =
          map_from_camera.rotation * camera().unproject(Eigen::Vector2d(u, v), 1.0);
      double nearest = 60.0;
      const auto hit = [&](double wall, double from, double step) {
        const double z = (wall - from) / step;
        if (z > 0.0) nearest = std::min(nearest, z);
      };
      hit(4.0, pose.x, ray.x());
      hit(-2.0, pose.x, ray.x());
      hit(3.0, pose.y, ray.y());
      hit(-1.0, pose.y, ray.y());
      frame.depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1000.0 * nearest);
    }
  }
  return frame;
}

struct Rover {
  ViewContinuity continuity{camera(), base_from_camera()};
  /// The camera is at `truth`, wheels and gyro say `believed`.
  bool sees(double time_s, const TPose2D& truth, const TPose2D& believed) {
    return continuity.follows(frame_in_room(time_s, truth), from_planar(believed));
  }
};

TEST(ViewContinuity, ADrivenAndTurnedRoverSeesOn) {
  Rover rover;
  EXPECT_FALSE(rover.sees(0.0, {0, 0, 0}, {0, 0, 0})) << "nothing to compare the first frame with";
  TPose2D pose{0, 0, 0};
  for (int i = 1; i < 60; ++i) {
    pose = {pose.x + 0.02, pose.y + 0.01, pose.phi + 0.1};  // 1.5 rad/s at 15 frames a second
    EXPECT_TRUE(rover.sees(i / 15.0, pose, pose)) << "frame " << i;
  }
}

TEST(ViewContinuity, ARoverCarriedOffBetweenFramesDoesNot) {
  Rover rover;
  rover.sees(0.0, {0, 0, 0}, {0, 0, 0});
  EXPECT_FALSE(rover.sees(1 / 15.0, {1.5, 1.0, 2.1}, {0.02, 0, 0}));
}

TEST(ViewContinuity, ARoverLiftedAndTurnedSlowlyDoesNot) {
  Rover rover;
  bool broken = false;
  for (int i = 0; i < 30; ++i) {
    const TPose2D carried{0.0, 0.05 * i, 0.08 * i};
    broken |= i > 0 && !rover.sees(i / 15.0, carried, {0, 0, 0});
  }
  EXPECT_TRUE(broken);
}

TEST(ViewContinuity, AGapOrAnEmptyDepthImageTellsNothing) {
  Rover rover;
  rover.sees(0.0, {0, 0, 0}, {0, 0, 0});
  EXPECT_FALSE(rover.sees(1.0, {0, 0, 0}, {0, 0, 0}));
  CameraFrame dark;
  dark.time_s = 1.07;
  EXPECT_FALSE(rover.continuity.follows(dark, from_planar({0, 0, 0})));
  EXPECT_FALSE(rover.sees(1.13, {0, 0, 0}, {0, 0, 0}));
  EXPECT_TRUE(rover.sees(1.2, {0, 0, 0}, {0, 0, 0}));
}

}  // namespace
}  // namespace rovigo::slam
