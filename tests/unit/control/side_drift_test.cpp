#include "control/side_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rovigo::control {
namespace {

constexpr double kPeriodS = 1.0 / 30.0, kShare = 0.5;

/// A rover that circles, slid by `drift`, seen with noise; the observer as the tracker runs it.
TPoint2D learned(const TPoint2D& drift, double noise_m, double seconds) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  PosePredictor predictor({.lag_s = 0.0, .command_delay_s = 0.0});
  SideDriftEstimator estimator;
  TPose2D pose;
  predictor.advance(0.0);
  predictor.reset(0.0, pose);
  const TTwist2D command(0.3, 0.0, 0.4);
  predictor.set_command(command);
  for (double t = kPeriodS; t < seconds; t += kPeriodS) {
    predictor.advance(t);
    const double heading = pose.phi + command.omega * kPeriodS / 2;
    const double c = std::cos(heading), s = std::sin(heading);
    const double aside = (drift.y * c - drift.x * s) * kPeriodS;
    const double chord = command.vx * kPeriodS;
    pose = {pose.x + chord * c - aside * s, pose.y + chord * s + aside * c,
            maps::wrap_angle(pose.phi + command.omega * kPeriodS)};
    const TPose2D seen(pose.x + noise_m * normal(random), pose.y + noise_m * normal(random),
                       pose.phi);
    estimator.add(seen, predictor.at(t), kShare, predictor.rolled_s(t - kPeriodS, t));
    predictor.set_side_drift(estimator.drift_m_s());
    predictor.correct(t, seen, kShare);
  }
  return estimator.drift_m_s();
}

TEST(SideDrift, LearnsADriftOnACircleToATenthWithinHalfAMinute) {
  const TPoint2D found = learned({0.012, -0.016}, 0.0, 30.0);
  EXPECT_NEAR(found.x, 0.012, 0.002);
  EXPECT_NEAR(found.y, -0.016, 0.002);
}

TEST(SideDrift, NoiseOfACentimetreMakesItBelieveInLessThanASlopeOfTwoDegrees) {
  const TPoint2D found = learned({0.0, 0.0}, 0.01, 20.0);
  EXPECT_LT(std::hypot(found.x, found.y), 0.007);
}

TEST(SideDrift, StaysBoundedWhateverPosesSay) {
  SideDriftEstimator estimator;
  for (int i = 0; i < 10000; ++i) {
    estimator.add({1.0 * i, -3.0 * i, 0.1 * i}, {0.0, 0.0, 0.1 * i}, 1.0, 0.03);
    const TPoint2D& d = estimator.drift_m_s();
    ASSERT_LE(std::hypot(d.x, d.y), SideDriftEstimator::kMostMS + 1e-12);
  }
}

TEST(SideDrift, AStandingRoverTeachesNothing) {
  SideDriftEstimator estimator;
  for (int i = 0; i < 100; ++i) estimator.add({0.0, 0.01, 0.0}, {}, 0.5, 0.0);
  EXPECT_EQ(estimator.drift_m_s().y, 0.0);
}

}  // namespace
}  // namespace rovigo::control
