#include "slam/se3.h"

#include <gtest/gtest.h>

#include <random>

namespace rovigo::slam {
namespace {

Vector6d random_step(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  Vector6d v;
  for (int i = 0; i < 6; ++i) v(i) = u(random);
  return v;
}

TEST(Se3, LogUndoesExpFromTinyToNearlyHalfATurn) {
  std::mt19937_64 random(11);
  for (const double size : {1e-12, 1e-8, 1e-4, 0.1, 1.0, 1.7}) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d w = random_step(random, size).head<3>();
      EXPECT_LT((so3_log(so3_exp(w)) - w).norm(), 1e-9 * std::max(1.0, size)) << "size " << size;
    }
  }
}

TEST(Se3, LocalUndoesRetract) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 100; ++i) {
    const Se3 pose = retract(Se3{}, random_step(random, 1.5));
    const Vector6d step = random_step(random, 0.5);
    EXPECT_LT((local(pose, retract(pose, step)) - step).norm(), 1e-9);
  }
}

TEST(Se3, AnInverseCancelsItsPose) {
  std::mt19937_64 random(13);
  for (int i = 0; i < 100; ++i) {
    const Se3 pose = retract(Se3{}, random_step(random, 1.5));
    EXPECT_LT(local(Se3{}, pose * pose.inverse()).norm(), 1e-9);
  }
}

TEST(Se3, MrptPosesComeBackUnchanged) {
  const mrpt::poses::CPose3D pose(1.0, -2.0, 0.5, 0.3, -0.2, 0.1);
  const mrpt::poses::CPose3D back = to_mrpt(from_mrpt(pose));
  EXPECT_LT((pose - back).asVectorVal().norm(), 1e-9);
}

TEST(Se3, APlanarPoseKeepsItsHeading) {
  const TPose2D pose{1.0, 2.0, -2.5};
  const TPose2D back = to_planar(from_planar(pose));
  EXPECT_NEAR(back.x, 1.0, 1e-12);
  EXPECT_NEAR(back.y, 2.0, 1e-12);
  EXPECT_NEAR(back.phi, -2.5, 1e-12);
}

}  // namespace
}  // namespace rovigo::slam
