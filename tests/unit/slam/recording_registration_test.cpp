// Depth registered to another camera: against closed forms, and against a plane seen by both.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "slam/recording/depth_registration.h"
#include "slam/recording/images.h"
#include "slam/recording/rgbd_normalizer.h"
#include "tests/support/recordings.h"

namespace rovigo::slam {
namespace {

constexpr double kMillimetre = 0.001;

mrpt::img::TCamera camera(unsigned columns, unsigned rows, double focal_px) {
  mrpt::img::TCamera model;
  model.ncols = columns;
  model.nrows = rows;
  model.setIntrinsicParamsFromValues(focal_px, focal_px, (columns - 1) / 2.0, (rows - 1) / 2.0);
  return model;
}

mrpt::math::CMatrix_u16 flat_wall(unsigned columns, unsigned rows, std::uint16_t depth) {
  mrpt::math::CMatrix_u16 image(static_cast<int>(rows), static_cast<int>(columns));
  image.fill(depth);
  return image;
}

TEST(DepthRegistration, BetweenEqualCamerasChangesNothing) {
  const auto model = camera(64, 48, 60);
  const DepthRegistration registration({model, model, {}});
  mrpt::math::CMatrix_u16 depth(48, 64);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) depth(v, u) = static_cast<std::uint16_t>(1000 + 7 * u + 11 * v);
  }
  depth(20, 30) = 0;
  EXPECT_EQ(registration.apply(depth, kMillimetre, false), depth);
}

TEST(DepthRegistration, ACameraBesideSeesAFlatWallShiftedByTheDisparity) {
  // The colour camera sits 0.05 m to the right: at 1 m and f = 60 px everything moves 3 px left.
  const auto model = camera(64, 48, 60);
  const DepthRegistration registration({model, model, mrpt::poses::CPose3D(-0.05, 0, 0)});
  auto depth = flat_wall(64, 48, 1000);
  depth(10, 40) = 0;
  const auto registered = registration.apply(depth, kMillimetre, false);
  EXPECT_EQ(registered(10, 37), 0);
  EXPECT_EQ(registered(10, 36), 1000);
  EXPECT_EQ(registered(10, 38), 1000);
  EXPECT_EQ(registered(5, 60), 1000);
  EXPECT_EQ(registered(5, 61), 0);  // the depth camera did not see that far right
}

TEST(DepthRegistration, MovingForwardShortensTheDepth) {
  const auto model = camera(64, 48, 60);
  const DepthRegistration registration({model, model, mrpt::poses::CPose3D(0, 0, -0.2)});
  const auto registered = registration.apply(flat_wall(64, 48, 1000), kMillimetre, false);
  EXPECT_EQ(registered(24, 32), 800);
}

TEST(DepthRegistration, AColourCameraOfHigherResolutionSeesNoHoles) {
  const DepthRegistration registration({camera(64, 48, 60), camera(192, 144, 180), {}});
  const auto registered = registration.apply(flat_wall(64, 48, 1500), kMillimetre, false);
  ASSERT_EQ(registered.cols(), 192);
  ASSERT_EQ(registered.rows(), 144);
  for (int v = 0; v < 144; ++v) {
    for (int u = 0; u < 192; ++u) ASSERT_EQ(registered(v, u), 1500) << u << ", " << v;
  }
}

TEST(DepthRegistration, TheNearestSurfaceHidesWhatIsBehind) {
  const auto model = camera(64, 48, 60);
  const DepthRegistration registration({model, model, mrpt::poses::CPose3D(-0.1, 0, 0)});
  auto depth = flat_wall(64, 48, 3000);  // moves 2 px
  for (int v = 0; v < 48; ++v) {
    for (int u = 30; u < 40; ++u) depth(v, u) = 1000;  // moves 6 px, over the wall
  }
  const auto registered = registration.apply(depth, kMillimetre, false);
  for (int u = 24; u < 34; ++u) EXPECT_EQ(registered(20, u), 1000) << u;
  EXPECT_EQ(registered(20, 23), 3000);
  EXPECT_EQ(registered(20, 36), 0);  // behind the near surface, never seen
  EXPECT_EQ(registered(20, 39), 3000);
}

TEST(DepthRegistration, RangesBecomeDepths) {
  const auto model = camera(65, 49, 60);
  const DepthRegistration registration({model, model, {}});
  mrpt::math::CMatrix_u16 range(49, 65);
  for (int v = 0; v < 49; ++v) {
    for (int u = 0; u < 65; ++u) {
      const double x = (u - 32.0) / 60;
      const double y = (v - 24.0) / 60;
      range(v, u) = static_cast<std::uint16_t>(std::lround(2000 * std::sqrt(1 + x * x + y * y)));
    }
  }
  const auto depth = registration.apply(range, kMillimetre, true);
  for (int v = 0; v < 49; ++v) {
    for (int u = 0; u < 65; ++u) EXPECT_NEAR(depth(v, u), 2000, 1.1);
  }
}

TEST(DepthRegistration, ADistortedColourCameraSeesAPlaneWhereItsModelPutsIt) {
  auto color = camera(64, 48, 50);
  color.dist = {0.2, -0.3, 0.002, -0.001, 0.1, 0, 0, 0};
  color.distortion = mrpt::img::DistortionModel::plumb_bob;
  const auto depth_camera = camera(128, 96, 90);  // sees more than the colour camera
  const mrpt::poses::CPose3D color_from_depth(0.03, -0.01, 0.02, 0.02, -0.03, 0.01);
  const DepthRegistration registration({depth_camera, color, color_from_depth});
  // Plane z = 2 + 0.3 x + 0.2 y of the depth camera's frame.
  mrpt::math::CMatrix_u16 depth(96, 128);
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 128; ++u) {
      const double x = (u - depth_camera.cx()) / 90;
      const double y = (v - depth_camera.cy()) / 90;
      depth(v, u) = static_cast<std::uint16_t>(std::lround(2000 / (1 - 0.3 * x - 0.2 * y)));
    }
  }
  const auto registered = registration.apply(depth, kMillimetre, false);
  int checked = 0;
  for (int v = 8; v < 40; ++v) {
    for (int u = 8; u < 56; ++u) {
      if (registered(v, u) == 0) continue;
      // Undo the distortion by fixed-point iteration, then intersect the ray with the plane.
      const double xd = (u - color.cx()) / color.fx();
      const double yd = (v - color.cy()) / color.fy();
      double x = xd;
      double y = yd;
      for (int i = 0; i < 50; ++i) {
        const double r2 = x * x + y * y;
        const double radial = 1 + r2 * (0.2 + r2 * (-0.3 + r2 * 0.1));
        x = (xd - 2 * 0.002 * x * y + 0.001 * (r2 + 2 * x * x)) / radial;
        y = (yd - 0.002 * (r2 + 2 * y * y) + 2 * 0.001 * x * y) / radial;
      }
      const auto origin = color_from_depth.inverseComposePoint({0, 0, 0});
      const auto ahead = color_from_depth.inverseComposePoint({x, y, 1});
      const auto ray = ahead - origin;
      const double at =
          (2 + 0.3 * origin.x + 0.2 * origin.y - origin.z) / (ray.z - 0.3 * ray.x - 0.2 * ray.y);
      EXPECT_NEAR(registered(v, u) * kMillimetre, at, 0.012) << u << ", " << v;
      ++checked;
    }
  }
  EXPECT_GT(checked, 1400);  // of 1536
}

TEST(DepthRegistration, HostileCalibrationNeitherCrashesNorWritesOutside) {
  auto wild = camera(64, 48, 60);
  wild.dist = {900, -900, 900, 900, -900, 900, -900, 900};
  const DepthRegistration registration({wild, wild, mrpt::poses::CPose3D(1e5, -1e5, 1e5, 1, 2, 3)});
  const auto registered = registration.apply(flat_wall(64, 48, 65535), 0.1, true);
  EXPECT_EQ(registered.rows(), 48);
}

TEST(RgbdNormalizer, LeavesARegisteredFrameAsItIs) {
  auto scan = test::test_frame(1.0, test::test_rig());
  const auto before = *scan;
  std::string problem;
  ASSERT_TRUE(RgbdNormalizer().normalize(*scan, problem)) << problem;
  EXPECT_EQ(scan->rangeImage, before.rangeImage);
  EXPECT_LT((scan->sensorPose - before.sensorPose).norm(), 1e-15);
}

TEST(RgbdNormalizer, MovesTheSensorPoseToTheColourCamera) {
  auto scan = test::test_frame(1.0, test::test_rig());
  // The colour camera 0.05 m to the left of the depth camera (y of the sensor's frame).
  scan->sensorPose = mrpt::poses::CPose3D(0.1, 0, 0.2);
  scan->relativePoseIntensityWRTDepth =
      mrpt::poses::CPose3D(0, 0.05, 0) + scan->relativePoseIntensityWRTDepth;
  std::string problem;
  ASSERT_TRUE(RgbdNormalizer().normalize(*scan, problem)) << problem;
  EXPECT_NEAR(scan->sensorPose.x(), 0.1, 1e-9);
  EXPECT_NEAR(scan->sensorPose.y(), 0.05, 1e-9);
  EXPECT_NEAR(scan->sensorPose.z(), 0.2, 1e-9);
  EXPECT_NEAR(scan->sensorPose.yaw(), 0.0, 1e-6);
  EXPECT_TRUE(scan->doDepthAndIntensityCamerasCoincide());
}

TEST(RgbdNormalizer, MakesThreeChannelsOfGrey) {
  auto scan = test::test_frame(1.0, test::test_rig());
  scan->intensityImage = mrpt::img::CImage(64, 48, mrpt::img::CH_GRAY);
  std::string problem;
  ASSERT_TRUE(RgbdNormalizer().normalize(*scan, problem)) << problem;
  EXPECT_EQ(color_view(*scan).type(), CV_8UC3);
}

TEST(RgbdNormalizer, SaysWhyAFrameCannotBeUsed) {
  const auto problem_after =
      [](const std::function<void(mrpt::obs::CObservation3DRangeScan&)>& spoil) {
        auto scan = test::test_frame(1.0, test::test_rig());
        spoil(*scan);
        std::string problem;
        EXPECT_FALSE(RgbdNormalizer().normalize(*scan, problem));
        return problem;
      };
  using ::testing::HasSubstr;
  using Scan = mrpt::obs::CObservation3DRangeScan;
  EXPECT_THAT(problem_after([](Scan& s) { s.hasRangeImage = false; }), HasSubstr("no depth"));
  EXPECT_THAT(problem_after([](Scan& s) { s.hasIntensityImage = false; }), HasSubstr("no colour"));
  EXPECT_THAT(problem_after([](Scan& s) { s.rangeUnits = 0; }), HasSubstr("unit"));
  EXPECT_THAT(problem_after([](Scan& s) { s.rangeUnits = std::nanf(""); }), HasSubstr("unit"));
  EXPECT_THAT(problem_after([](Scan& s) { s.cameraParams.ncols = 640; }), HasSubstr("640 x 48"));
  EXPECT_THAT(problem_after([](Scan& s) { s.cameraParams.fx(std::nan("")); }), HasSubstr("focal"));
  EXPECT_THAT(problem_after([](Scan& s) { s.sensorPose.x(std::nan("")); }), HasSubstr("pose"));
}

}  // namespace
}  // namespace rovigo::slam
