#include "slam/camera_model.h"

#include <gtest/gtest.h>

#include "maps/error.h"

namespace rovigo::slam {
namespace {

mrpt::img::TCamera freiburg1() {
  mrpt::img::TCamera c;
  c.ncols = 640;
  c.nrows = 480;
  c.setIntrinsicParamsFromValues(517.306408, 516.469215, 318.643040, 255.313989);
  c.distortion = mrpt::img::DistortionModel::plumb_bob;
  c.dist = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314, 0, 0, 0};
  return c;
}

TEST(CameraModel, DistortingUndoesUndistortingAllOverTheImage) {
  const CameraModel camera(freiburg1());
  for (double u = 5; u < 640; u += 35) {
    for (double v = 5; v < 480; v += 35) {
      const Eigen::Vector2d raw(u, v);
      EXPECT_LT((camera.distort(camera.undistort(raw)) - raw).norm(), 1e-3) << u << ", " << v;
    }
  }
}

TEST(CameraModel, UnprojectedPointsProjectBack) {
  const CameraModel camera(freiburg1());
  const Eigen::Vector2d pixel(123.0, 321.0);
  const Eigen::Vector3d p = camera.unproject(pixel, 2.5);
  EXPECT_DOUBLE_EQ(p.z(), 2.5);
  EXPECT_LT((camera.project(p) - pixel).norm(), 1e-9);
}

TEST(CameraModel, CoefficientsWithoutALensModelAreIgnored) {
  mrpt::img::TCamera c = freiburg1();
  c.distortion = mrpt::img::DistortionModel::none;
  const CameraModel camera(c);
  EXPECT_EQ(camera.undistort({10, 10}), Eigen::Vector2d(10, 10));
}

TEST(CameraModel, ACameraWithoutFocalLengthIsRefused) {
  mrpt::img::TCamera c;
  EXPECT_THROW(CameraModel{c}, maps::InputError);
}

TEST(CameraModel, AFishEyeIsRefused) {
  mrpt::img::TCamera c = freiburg1();
  c.distortion = mrpt::img::DistortionModel::kannala_brandt;
  EXPECT_THROW(CameraModel{c}, maps::InputError);
}

}  // namespace
}  // namespace rovigo::slam
