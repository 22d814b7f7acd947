#include "slam/trajectory_history.h"

#include <gtest/gtest.h>

#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

TEST(TrajectoryHistory, AFrameReplacesThePoseDeadReckonedForTheSameMoment) {
  TrajectoryHistory history;
  history.add(1.00, -1, Se3{}, false);
  history.add(1.00, -1, Se3{}, true);
  history.add(1.02, -1, Se3{}, false);
  history.add(1.06, -1, Se3{}, true);
  const LandmarkMap no_map(SlamConfig{}, CameraModel(test::pinhole()), Se3{});
  const auto poses = history.poses(no_map);
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_TRUE(poses[0].is_camera_frame);
  EXPECT_FALSE(poses[1].is_camera_frame);  // 0.04 s before the frame: kept
  EXPECT_TRUE(poses[2].is_camera_frame);
}

}  // namespace
}  // namespace rovigo::slam
