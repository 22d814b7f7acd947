#include "slam/trajectory_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "maps/error.h"
#include "maps/geometry.h"

namespace rovigo::slam {
namespace {

using mrpt::poses::CPose3D;

/// A helix, so that no axis is free; 30 Hz for 10 s.
std::vector<StampedPose> helix(double rate_hz = 30.0, double duration_s = 10.0) {
  std::vector<StampedPose> poses;
  const int count = static_cast<int>(duration_s * rate_hz) + 1;
  for (int i = 0; i < count; ++i) {
    const double t = i / rate_hz;
    poses.push_back({100.0 + t, CPose3D(std::cos(t), std::sin(t), 0.1 * t, t, 0.1, -0.05)});
  }
  return poses;
}

std::vector<StampedPose> moved(std::vector<StampedPose> poses, const CPose3D& by) {
  for (StampedPose& stamped : poses) stamped.pose = by + stamped.pose;
  return poses;
}

TEST(TrajectoryEvaluation, ARigidlyMovedCopyHasNoError) {
  const auto truth = helix();
  const auto errors = evaluate_trajectory(moved(truth, CPose3D(5, -3, 2, 2.5, 0.7, -1.2)), truth);
  EXPECT_EQ(errors.associated, static_cast<int>(truth.size()));
  EXPECT_NEAR(errors.ate_rmse_m, 0.0, 1e-9);
  EXPECT_NEAR(errors.ate_max_m, 0.0, 1e-9);
  EXPECT_NEAR(errors.rpe_translation_m, 0.0, 1e-9);
  EXPECT_NEAR(errors.rpe_rotation_rad, 0.0, 1e-7);
  EXPECT_NEAR(errors.similarity_scale, 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(errors.coverage, 1.0);
}

TEST(TrajectoryEvaluation, IndependentNoiseShowsAsItsOwnSize) {
  constexpr double kSigma_m = 0.05;
  const auto truth = helix(30.0, 100.0);
  auto estimate = truth;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> noise(0.0, kSigma_m);
  for (StampedPose& stamped : estimate) {
    stamped.pose.x_incr(noise(generator));
    stamped.pose.y_incr(noise(generator));
    stamped.pose.z_incr(noise(generator));
  }
  const auto errors = evaluate_trajectory(estimate, truth);
  EXPECT_NEAR(errors.ate_rmse_m, kSigma_m * std::sqrt(3.0), 0.002);
  // Two independent positions differ by sqrt(2) times that.
  EXPECT_NEAR(errors.rpe_translation_m, kSigma_m * std::sqrt(6.0), 0.003);
}

TEST(TrajectoryEvaluation, AScaledCopyKeepsItsErrorAndReportsTheScale) {
  // On a circle of radius 1 scaled by 1.1, every point is 0.1 off after rigid alignment.
  std::vector<StampedPose> truth;
  std::vector<StampedPose> estimate;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * maps::kPi / 180.0;
    truth.push_back({0.1 * i, CPose3D(std::cos(angle), std::sin(angle), 0, angle, 0, 0)});
    estimate.push_back(
        {0.1 * i, CPose3D(1.1 * std::cos(angle), 1.1 * std::sin(angle), 0, angle, 0, 0)});
  }
  const auto errors = evaluate_trajectory(estimate, truth);
  EXPECT_NEAR(errors.ate_rmse_m, 0.1, 1e-9);
  EXPECT_NEAR(errors.ate_max_m, 0.1, 1e-9);
  EXPECT_NEAR(errors.similarity_scale, 1.0 / 1.1, 1e-9);
}

TEST(TrajectoryEvaluation, AMirroredTrajectoryIsNotAlignedByReflection) {
  const auto truth = helix();
  auto mirrored = truth;
  for (StampedPose& stamped : mirrored) {
    const CPose3D& p = stamped.pose;
    stamped.pose = CPose3D(p.x(), p.y(), -p.z(), p.yaw(), p.pitch(), p.roll());
  }
  EXPECT_GT(evaluate_trajectory(mirrored, truth).ate_rmse_m, 0.1);
}

TEST(TrajectoryEvaluation, ATurnRateErrorShowsInRotationPerSecond) {
  std::vector<StampedPose> truth;
  std::vector<StampedPose> estimate;
  for (int i = 0; i <= 300; ++i) {
    const double t = i / 30.0;
    truth.push_back({t, CPose3D(0.1 * t, 0, 0, 0.50 * t, 0, 0)});
    estimate.push_back({t, CPose3D(0.1 * t, 0, 0, 0.53 * t, 0, 0)});
  }
  EXPECT_NEAR(evaluate_trajectory(estimate, truth).rpe_rotation_rad, 0.03, 1e-9);
}

TEST(TrajectoryEvaluation, OnlyPosesWithinTenMillisecondsAreCompared) {
  const auto truth = helix();
  auto late = truth;
  for (StampedPose& stamped : late) stamped.time_s += 0.009;
  EXPECT_EQ(evaluate_trajectory(late, truth).associated, static_cast<int>(truth.size()));
  for (StampedPose& stamped : late) stamped.time_s += 0.003;
  EXPECT_THROW(evaluate_trajectory(late, truth), maps::InputError);
}

TEST(TrajectoryEvaluation, EachTruePoseIsUsedOnce) {
  const auto truth = helix(30.0);
  const auto dense = helix(300.0);
  EXPECT_EQ(evaluate_trajectory(dense, truth).associated, static_cast<int>(truth.size()));
}

TEST(TrajectoryEvaluation, CoverageIsTheShareOfTimeThatHasAPose) {
  const auto truth = helix(100.0, 10.0);
  auto estimate = helix(30.0, 10.0);
  // 3 s of poses are missing; each end of the gap is still covered for 0.02 s.
  std::erase_if(estimate, [](const StampedPose& stamped) {
    return stamped.time_s > 104.001 && stamped.time_s < 106.999;
  });
  EXPECT_NEAR(evaluate_trajectory(estimate, truth).coverage, 1.0 - (3.0 - 0.04) / 10.0, 0.002);
}

TEST(TrajectoryEvaluation, CoverageCountsTimeNotHowDenseTheTruthIs) {
  auto truth = helix(10.0, 10.0);
  const auto dense = helix(1000.0, 5.0);  // the first half, a hundred times denser
  truth.insert(truth.end(), dense.begin(), dense.end());
  const auto estimate = helix(100.0, 5.0);
  EXPECT_NEAR(evaluate_trajectory(estimate, truth).coverage, 0.5, 0.02);
}

TEST(TrajectoryEvaluation, AStandingRoverIsEvaluatedWithoutDividingByZero) {
  std::vector<StampedPose> still;
  for (int i = 0; i < 100; ++i) still.push_back({0.1 * i, CPose3D(1, 2, 3, 0, 0, 0)});
  const auto errors = evaluate_trajectory(still, still);
  EXPECT_NEAR(errors.ate_rmse_m, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(errors.similarity_scale, 1.0);
}

TEST(TrajectoryEvaluation, FewerThanThreeCommonPosesAreRefused) {
  const auto truth = helix();
  const std::vector<StampedPose> two(truth.begin(), truth.begin() + 2);
  EXPECT_THROW(evaluate_trajectory(two, truth), maps::InputError);
  EXPECT_THROW(evaluate_trajectory({}, truth), maps::InputError);
  EXPECT_THROW(evaluate_trajectory(truth, {}), maps::InputError);
}

}  // namespace
}  // namespace rovigo::slam
