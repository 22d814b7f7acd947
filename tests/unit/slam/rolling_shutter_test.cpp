#include "slam/rolling_shutter.h"

#include <gtest/gtest.h>

#include <random>

#include "slam/se3.h"

namespace rovigo::slam {
namespace {

CameraModel any_camera() {
  mrpt::img::TCamera camera;
  camera.ncols = 640;
  camera.nrows = 480;
  camera.setIntrinsicParamsFromValues(520, 520, 320, 240);
  return CameraModel(camera);
}

/// The pixel that a row-by-row camera reads: its row decides when, and when decides its row.
Eigen::Vector2d read_by_rows(const Eigen::Vector3d& point, const CameraModel& camera,
                             const RollingShutter& shutter) {
  Eigen::Vector2d pixel = camera.project(point);
  for (int i = 0; i < 50; ++i) {
    const double late_s = ((pixel.y() + 0.5) / camera.height() - 0.5) * shutter.readout_s;
    pixel = camera.project(so3_exp(-shutter.turn_rate_rad_s * late_s) * point);
  }
  return pixel;
}

TEST(RollingShutter, TurningIsTakenOffEveryRow) {
  const CameraModel camera = any_camera();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double most_sheared = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point(0.5 * unit(random), 0.35 * unit(random), 1.0);
    const double x = unit(random), y = unit(random), z = unit(random);
    const RollingShutter shutter{.readout_s = 0.026, .turn_rate_rad_s = {2 * x, 2 * y, 2 * z}};
    const Eigen::Vector2d seen = read_by_rows(point, camera, shutter);
    most_sheared = std::max(most_sheared, (seen - camera.project(point)).norm());
    EXPECT_LT((at_middle_row(seen, seen.y(), camera, shutter) - camera.project(point)).norm(), 1e-6)
        << "point " << i;
  }
  EXPECT_GT(most_sheared, 10.0);  // or nothing was tested
}

TEST(RollingShutter, ACameraThatTakesAllRowsAtOnceOrStandsStillShearsNothing) {
  const CameraModel camera = any_camera();
  const Eigen::Vector2d pixel(100.25, 33.5);
  const Eigen::Vector3d turning(1.0, -2.0, 0.5);
  EXPECT_EQ(at_middle_row(pixel, 33.5, camera, {.readout_s = 0.0, .turn_rate_rad_s = turning}),
            pixel);
  EXPECT_LT((at_middle_row(pixel, 33.5, camera, {.readout_s = 0.03}) - pixel).norm(), 1e-9);
}

TEST(RollingShutter, RowsAboveAndBelowTheMiddleMoveOppositeWays) {
  const CameraModel camera = any_camera();
  const RollingShutter shutter{.readout_s = 0.03, .turn_rate_rad_s = {0.0, 1.0, 0.0}};
  const auto moved = [&](double v) {
    return at_middle_row({320.0, v}, v, camera, shutter).x() - 320.0;
  };
  EXPECT_LT(moved(20.0) * moved(460.0), 0.0);
  EXPECT_NEAR(moved(239.5), 0.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::slam
