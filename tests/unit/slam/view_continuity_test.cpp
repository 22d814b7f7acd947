#include "slam/view_continuity.h"

#include <gtest/gtest.h>

#include "tests/support/depth_room.h"

namespace rovigo::slam {
namespace {

const test::DepthRoom& room() {
  static const test::DepthRoom room(
      {{{-2, -1}, {4, -1}}, {{4, -1}, {4, 3}}, {{4, 3}, {-2, 3}}, {{-2, 3}, {-2, -1}}});
  return room;
}

struct Rover {
  ViewContinuity continuity{test::DepthRoom::camera(), test::DepthRoom::base_from_camera()};
  /// The camera is at `truth`, wheels and gyro say `believed`.
  bool sees(double time_s, const TPose2D& truth, const TPose2D& believed) {
    return continuity.follows(room().frame(time_s, truth), from_planar(believed));
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
