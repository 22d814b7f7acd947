#include "slam/camera_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::slam {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kReachPx = 8.0;

CameraFrame frame_of(const auto& depth_m) {
  CameraFrame frame;
  frame.depth.create(kHeight, kWidth, CV_16UC1);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      frame.depth.at<std::uint16_t>(v, u) =
          static_cast<std::uint16_t>(std::lround(1000.0 * depth_m(u, v)));
    }
  }
  return frame;
}

TEST(CameraFrame, OnlyTheFarSideOfAnOutlineIsBesideSomethingNearer) {
  const CameraFrame post = frame_of([](int u, int) { return u < 300 ? 1.5 : 4.0; });
  EXPECT_TRUE(post.is_beside_nearer({304, 200}, kReachPx, {}));
  EXPECT_FALSE(post.is_beside_nearer({296, 200}, kReachPx, {})) << "the post itself";
  EXPECT_FALSE(post.is_beside_nearer({320, 200}, kReachPx, {})) << "the wall, far from it";
}

TEST(CameraFrame, FloorsAndCornersOfRoomsEndNowhere) {
  // A camera 0.25 m over the floor; depth runs away by centimetres from row to row.
  const CameraFrame floor = frame_of(
      [](int, int v) { return v > 250 ? std::min(6.0, 0.25 * 460.0 / (v - 239.5)) : 6.0; });
  for (int v = 275; v < kHeight - 10; v += 3) {
    EXPECT_FALSE(floor.is_beside_nearer({320.0, double(v)}, kReachPx, {})) << "row " << v;
  }
  // Two walls that meet at 45 degrees to the view, 2 m off.
  const CameraFrame room =
      frame_of([](int u, int) { return 2.0 / (1.0 + std::abs(u - 320) / 460.0); });
  for (int u = 300; u < 340; ++u) {
    EXPECT_FALSE(room.is_beside_nearer({double(u), 200.0}, kReachPx, {})) << "column " << u;
  }
}

TEST(CameraFrame, WithoutDepthNothingIsNearer) {
  EXPECT_FALSE(CameraFrame{}.is_beside_nearer({10, 10}, kReachPx, {}));
  const CameraFrame hole = frame_of([](int u, int) { return u < 300 ? 1.5 : 0.0; });
  EXPECT_FALSE(hole.is_beside_nearer({303, 200}, kReachPx, {}));
  EXPECT_FALSE(hole.is_beside_nearer({1, 1}, kReachPx, {})) << "at the image's rim";
}

}  // namespace
}  // namespace rovigo::slam
