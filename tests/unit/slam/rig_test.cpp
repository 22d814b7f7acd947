#include "slam/rig.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "maps/geometry.h"

namespace rovigo::slam {
namespace {

using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

TPoint3D transformed(const CPose3D& pose, const TPoint3D& point) {
  return pose.composePoint(point);
}

void expect_near(const TPoint3D& a, const TPoint3D& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(Rig, OpticalAxesOfALevelSensorPointForwardRightAndDown) {
  const CPose3D base_from_camera = base_from_optical(CPose3D());
  expect_near(transformed(base_from_camera, {0, 0, 1}), {1, 0, 0});
  expect_near(transformed(base_from_camera, {1, 0, 0}), {0, -1, 0});
  expect_near(transformed(base_from_camera, {0, 1, 0}), {0, 0, -1});
}

TEST(Rig, SensorPositionStaysWhereItIs) {
  const CPose3D base_from_camera = base_from_optical(CPose3D(0.1, -0.2, 0.3, 0.4, 0.5, 0.6));
  expect_near(transformed(base_from_camera, {0, 0, 0}), {0.1, -0.2, 0.3});
}

TEST(Rig, ASensorPitchedDownSeesTheFloorAhead) {
  // Pitch is positive downwards about y (x forward, z up).
  const CPose3D base_from_camera = base_from_optical(CPose3D(0, 0, 1, 0, maps::kPi / 4, 0));
  const TPoint3D seen = transformed(base_from_camera, {0, 0, std::sqrt(2.0)});
  expect_near(seen, {1, 0, 0});
}

TEST(Rig, ConversionThereAndBackIsTheSamePose) {
  for (const CPose3D& pose :
       {CPose3D(), CPose3D(1, 2, 3, 0.3, -0.4, 0.5), CPose3D(-4, 0.1, 0.25, 3.1, 1.2, -2.9)}) {
    const CPose3D there_and_back = base_from_mrpt_sensor(base_from_optical(pose));
    EXPECT_LT((there_and_back.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen() -
               pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen())
                  .norm(),
              1e-12);
  }
}

}  // namespace
}  // namespace rovigo::slam
