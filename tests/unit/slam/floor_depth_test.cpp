#include "slam/floor_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

constexpr double kHeightM = 0.25, kWallM = 2.0;
const DepthConfig kConfig;
const FloorPlane kKnown{.sigma_height_m = 0.001, .sigma_tilt_rad = 0.001, .looks = 10};
const FloorPlane kMount{.sigma_height_m = 0.02, .sigma_tilt_rad = 0.03};  // nobody has looked yet

CameraModel camera() { return CameraModel(test::pinhole()); }

Se3 level_from_camera() { return test::looking_ahead(kHeightM); }

double floor_depth(int v) { return kHeightM * 460.0 / (v - 239.5); }

/// A floor up to a wall; each floor reading is the true depth times `read(u, v)`.
CameraFrame view(const std::function<double(int, int)>& read) {
  CameraFrame frame;
  frame.depth.create(480, 640, CV_16UC1);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      const bool wall = v <= 239 || floor_depth(v) > kWallM;
      const double z = wall ? kWallM : floor_depth(v) * read(u, v);
      frame.depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(1000.0 * z));
    }
  }
  return frame;
}

double even(int, int) { return 1.0; }
/// As a polished floor is read: waves as wide as a matching window, 5% high.
double wavy(int u, int v) { return 1.0 + 0.05 * std::sin(u / 9.0) * std::sin(v / 8.0 + 1.0); }

/// Worst error of the floor's depths as a share, over the rows of the near floor.
double worst_error(const CameraFrame& frame, const FloorDepth& floor, bool as_measured) {
  double worst = 0.0;
  for (int v = 330; v < 440; v += 5) {
    for (int u = 60; u < 580; u += 20) {
      const Eigen::Vector2d pixel(u, v);
      const double z = as_measured ? frame.depth_at(pixel, kConfig) : floor.at(pixel);
      if (z > 0.0) worst = std::max(worst, std::abs(z / floor_depth(v) - 1.0));
    }
  }
  return worst;
}

TEST(FloorDepth, DrawsAPolishedFloorsDepthsToThePlane) {
  const CameraModel model = camera();
  const CameraFrame frame = view(wavy);
  const FloorDepth floor(frame, model, kConfig, level_from_camera(), kKnown);
  EXPECT_GT(worst_error(frame, floor, true), 0.04);
  EXPECT_LT(worst_error(frame, floor, false), 0.02);
}

TEST(FloorDepth, LeavesARugAsItWasMeasured) {
  // 8 mm high and read evenly: what is measured is right, the plane 3% off.
  const CameraModel model = camera();
  const CameraFrame frame = view([](int, int) { return 1.0 - 0.008 / kHeightM; });
  const FloorDepth floor(frame, model, kConfig, level_from_camera(), kKnown);
  for (int v = 330; v < 440; v += 10) {
    const double measured = frame.depth_at({320, v}, kConfig);
    EXPECT_NEAR(floor.at({320, v}), measured, 0.003 * measured) << v;
  }
}

TEST(FloorDepth, LeavesWhatStandsOnTheFloorAsItWasMeasured) {
  const CameraModel model = camera();
  const CameraFrame frame = view(wavy);
  const FloorDepth floor(frame, model, kConfig, level_from_camera(), kKnown);
  // The wall's foot: lower than the floor's tolerance, but its depth no longer grows.
  const int foot = static_cast<int>(239.5 + kHeightM * 460.0 / kWallM) - 3;
  EXPECT_LT(kHeightM - kWallM * (foot - 239.5) / 460.0, 0.025);
  for (int u = 60; u < 580; u += 20) {
    EXPECT_EQ(floor.at({u, foot}), frame.depth_at({u, foot}, kConfig)) << u;
    EXPECT_EQ(floor.at({u, 100}), frame.depth_at({u, 100}, kConfig)) << u;
  }
}

TEST(FloorDepth, TakesNoDepthOfWhatTheFloorMirrors) {
  // In the left half the mirror image is matched: the wall's, below the floor and as far away.
  const CameraModel model = camera();
  const CameraFrame frame =
      view([](int u, int v) { return u < 320 ? kWallM / floor_depth(v) : 1.0; });
  const FloorDepth floor(frame, model, kConfig, level_from_camera(), kKnown);
  for (int v = 330; v < 440; v += 10) {
    ASSERT_NEAR(frame.depth_at({100, v}, kConfig), kWallM, 1e-6);
    EXPECT_EQ(floor.at({100, v}), 0.0) << v;
    EXPECT_EQ(floor.at({540, v}), frame.depth_at({540, v}, kConfig)) << v;
  }
  for (int u = 60; u < 580; u += 20) EXPECT_EQ(floor.at({u, 100}), kWallM) << u;
}

TEST(FloorDepth, TakesNoDepthFarBelowAFloorThatOnlyTheMountTellsOf) {
  const CameraModel model = camera();
  const auto mirrored = [](int u, int v) { return u < 320 ? kWallM / floor_depth(v) : 1.0; };
  const CameraFrame frame = view(mirrored);
  // Mounted 2 cm lower than it is said to be: the floor seems to be as much too low.
  Se3 said = level_from_camera();
  said.translation.z() -= 0.02;
  const FloorDepth floor(frame, model, kConfig, said, kMount);
  for (int v = 330; v < 440; v += 10) {
    EXPECT_EQ(floor.at({540, v}), frame.depth_at({540, v}, kConfig)) << v;
  }
  // From here on the wall's mirror image, at 2 m, lies 0.3 m below the floor or deeper.
  for (int v = 370; v < 440; v += 10) EXPECT_EQ(floor.at({100, v}), 0.0) << v;
}

TEST(FloorDepth, DrawsNothingToAFloorThatOnlyTheMountTellsOf) {
  const CameraModel model = camera();
  const CameraFrame frame = view(wavy);
  const FloorDepth floor(frame, model, kConfig, level_from_camera(), kMount);
  EXPECT_EQ(worst_error(frame, floor, false), worst_error(frame, floor, true));
}

TEST(FloorDepth, KeepsDepthsThatTiltAndUnevennessPutBelowTheFloor) {
  // 5 mm under the plane and seen 0.3 deg too steeply.
  const CameraModel model = camera();
  const CameraFrame frame = view([](int, int) { return 1.0 + 0.005 / kHeightM; });
  Se3 tilted = level_from_camera();
  tilted.rotation = so3_exp({0.0, 0.005, 0.0}) * tilted.rotation;
  const FloorDepth floor(frame, model, kConfig, tilted, kKnown);
  for (int v = 310; v < 440; v += 10) {
    EXPECT_EQ(floor.at({320, v}), frame.depth_at({320, v}, kConfig)) << v;
  }
}

TEST(FloorDepth, SaysHowUnevenlyTheFloorIsRead) {
  const CameraModel model = camera();
  const CameraFrame smooth = view(even), polished = view(wavy);
  EXPECT_LT(FloorDepth(smooth, model, kConfig, level_from_camera(), kKnown).roughness(), 0.002);
  EXPECT_NEAR(FloorDepth(polished, model, kConfig, level_from_camera(), kKnown).roughness(), 0.025,
              0.012);
  CameraFrame blind;
  blind.depth = cv::Mat::zeros(480, 640, CV_16UC1);
  EXPECT_EQ(FloorDepth(blind, model, kConfig, level_from_camera(), kKnown).roughness(), 0.0);
}

}  // namespace
}  // namespace rovigo::slam
