#include "slam/floor_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

CameraModel camera() { return CameraModel(test::pinhole()); }

Se3 nominal() { return test::looking_ahead(0.25, 0.1); }

/// The nominal camera tilted about the level frame's axes and raised.
Se3 mounted(double roll, double pitch, double up_m) {
  Se3 s = nominal();
  s.rotation = so3_exp({roll, pitch, 0}) * s.rotation;
  s.translation.z() += up_m;
  return s;
}

struct Scene {
  double noise_at_1m = 0.0022;
  double box_share = 0.0;     ///< of the view's columns, something 4 cm high lies there
  double mirror_share = 0.0;  ///< of the floor's returns that come from below it
  double wall_m = 3.0;
};

cv::Mat floor_view(const Se3& level_from_camera, const Scene& scene, std::mt19937_64& random) {
  const CameraModel model = camera();
  std::normal_distribution<double> noise(0.0, 1.0);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(0));
  for (int v = 0; v < 480; v += 2) {
    for (int u = 0; u < 640; u += 4) {
      const Eigen::Vector3d d = level_from_camera.rotation * model.unproject({u, v}, 1.0);
      const double top = u < scene.box_share * 640 ? 0.04 : 0.0;
      double z = scene.wall_m / d.x();
      if (d.z() < 0) z = std::min(z, (level_from_camera.translation.z() - top) / -d.z());
      if (share(random) < scene.mirror_share && d.z() < 0) z = scene.wall_m / d.x();
      z += scene.noise_at_1m * z * z * noise(random);
      depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(1000 * z));
    }
  }
  return depth;
}

FloorTracker after(int looks, const Se3& true_mount, const Scene& scene) {
  DepthScanner scanner(camera(), DepthConfig{});
  FloorTracker tracker;
  std::mt19937_64 random(7);
  for (int i = 0; i < looks; ++i) {
    const cv::Mat depth = floor_view(true_mount, scene, random);
    tracker.update(scanner.scan(depth, 0.001, tracker.corrected(nominal())));
  }
  return tracker;
}

void expect_upright(const FloorTracker& tracker, const Se3& true_mount, double height_tolerance_m,
                    double tilt_tolerance_rad) {
  const Se3 found = tracker.corrected(nominal());
  EXPECT_NEAR(found.translation.z(), true_mount.translation.z(), height_tolerance_m);
  // The vertical in the camera's frame; headings are not the floor's business.
  const Eigen::Vector3d a = found.rotation.row(2), b = true_mount.rotation.row(2);
  EXPECT_LT(std::acos(std::min(1.0, a.dot(b))), tilt_tolerance_rad);
}

TEST(FloorTracker, ACameraMountedAsPromisedIsLeftAlone) {
  expect_upright(after(20, nominal(), {}), nominal(), 0.002, 0.002);
}

TEST(FloorTracker, TiltAndHeightOfTheMountAreFound) {
  for (const auto& [roll, pitch, up] :
       {std::tuple{0.0, 0.035, 0.0}, {0.0, -0.035, 0.01}, {0.02, 0.01, -0.01}}) {
    const Se3 mount = mounted(roll, pitch, up);
    expect_upright(after(20, mount, {}), mount, 0.003, 0.003);
  }
}

TEST(FloorTracker, ThingsOnTheFloorDoNotTiltIt) {
  expect_upright(after(30, nominal(), {.box_share = 0.3}), nominal(), 0.006, 0.008);
}

TEST(FloorTracker, MirroredReturnsFromBelowDoNotPullItDown) {
  const Se3 mount = mounted(0.0, 0.02, 0.0);
  expect_upright(after(30, mount, {.mirror_share = 0.6}), mount, 0.003, 0.004);
}

TEST(FloorTracker, NoiseOfSeveralCentimetresIsAveragedOut) {
  const Se3 mount = mounted(0.0, 0.02, 0.0);
  expect_upright(after(40, mount, {.noise_at_1m = 0.02}), mount, 0.006, 0.008);
}

TEST(FloorTracker, WithoutFloorInViewTheMountIsBelieved) {
  Scene near_wall;
  near_wall.wall_m = 0.4;
  const FloorTracker tracker = after(10, mounted(0.0, 0.02, 0.0), near_wall);
  EXPECT_EQ(tracker.plane().looks, 0);
  expect_upright(tracker, nominal(), 1e-9, 1e-6);
}

TEST(FloorTracker, ItsUncertaintyShrinksWithWhatItSees) {
  const FloorTracker tracker = after(10, nominal(), {});
  EXPECT_EQ(tracker.plane().looks, 10);
  EXPECT_LT(tracker.plane().sigma_height_m, 0.005);
  EXPECT_LT(tracker.plane().sigma_tilt_rad, 0.005);
}

}  // namespace
}  // namespace rovigo::slam
