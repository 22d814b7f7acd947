#include "slam/trajectory_history.h"

#include <gtest/gtest.h>

namespace rovigo::slam {
namespace {

mrpt::img::TCamera any_camera() {
  mrpt::img::TCamera camera;
  camera.ncols = 640;
  camera.nrows = 480;
  camera.setIntrinsicParamsFromValues(460, 460, 320, 240);
  return camera;
}

TEST(TrajectoryHistory, AFrameReplacesThePoseDeadReckonedForTheSameMoment) {
  TrajectoryHistory history;
  history.add(1.00, -1, Se3{}, false);
  history.add(1.00, -1, Se3{}, true);
  history.add(1.02, -1, Se3{}, false);
  history.add(1.06, -1, Se3{}, true);
  const LandmarkMap no_map(SlamConfig{}, CameraModel(any_camera()), Se3{});
  const auto poses = history.poses(no_map);
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_TRUE(poses[0].is_camera_frame);
  EXPECT_FALSE(poses[1].is_camera_frame);  // 0.04 s before the frame: kept
  EXPECT_TRUE(poses[2].is_camera_frame);
}

}  // namespace
}  // namespace rovigo::slam
