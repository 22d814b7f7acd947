#include "slam/pose_outlier_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::slam {
namespace {

using Pose = PoseOutlierFilter::Pose;
constexpr double kPi = 3.14159265358979323846;

TEST(PoseOutlierFilter, TakesTheFirstPoseAsItIs) {
  PoseOutlierFilter filter;
  EXPECT_EQ(filter.add({1.0, -2.0, 0.5}), (Pose{1.0, -2.0, 0.5}));
}

TEST(PoseOutlierFilter, FollowsItsFormula) {
  PoseOutlierFilterConfig config;
  config.tau_max = 0.5;
  config.tau_step = 0.1;
  PoseOutlierFilter filter(config);
  filter.add({0.0, 0.0, 0.0});                   // settled: tau falls to 0.4
  const Pose out = filter.add({0.1, 0.2, 0.1});  // and to 0.3
  EXPECT_NEAR(filter.tau()[0], 0.3, 1e-12);
  EXPECT_NEAR(out[0], 0.7 * 0.1, 1e-12);
  EXPECT_NEAR(out[1], 0.7 * 0.2, 1e-12);
  EXPECT_NEAR(out[2], 0.7 * 0.1, 1e-12);
}

TEST(PoseOutlierFilter, TauFallsByA120thASampleDownToItsMinimum) {
  PoseOutlierFilter filter;
  filter.add({0.0, 0.0, 0.0});
  const Pose before = filter.tau();
  filter.add({0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(before[i] - filter.tau()[i], 1.0 / 120.0, 1e-12);
  for (int i = 0; i < 200; ++i) filter.add({0.0, 0.0, 0.0});
  EXPECT_EQ(filter.tau(), (Pose{0.1, 0.1, 0.08}));
}

TEST(PoseOutlierFilter, AJumpOnOneAxisIsHeldBackOnThatAxisAlone) {
  PoseOutlierFilter filter;
  for (int i = 0; i < 200; ++i) filter.add({0.0, 0.0, 0.0});
  const Pose out = filter.add({5.0, 0.1, 0.0});
  EXPECT_NEAR(out[0], 0.5, 1e-12);   // tau is back at 0.9
  EXPECT_NEAR(out[1], 0.09, 1e-12);  // tau stays at 0.1
}

TEST(PoseOutlierFilter, TurningThroughPiIsNoJump) {
  PoseOutlierFilter filter;
  for (int i = 0; i < 200; ++i) filter.add({0.0, 0.0, kPi - 0.01});
  const Pose out = filter.add({0.0, 0.0, -kPi + 0.01});
  EXPECT_NEAR(filter.tau()[2], 0.08, 1e-12);
  EXPECT_LT(std::abs(std::abs(out[2]) - kPi), 0.011);
}

TEST(PoseOutlierFilter, PosesThatAreNotFiniteChangeNothing) {
  PoseOutlierFilter filter;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter.add({nan, 0.0, 0.0}), (Pose{0.0, 0.0, 0.0}));
  filter.add({1.0, 1.0, 1.0});
  EXPECT_EQ(filter.add({1.0, nan, 1.0}), (Pose{1.0, 1.0, 1.0}));
  EXPECT_EQ(filter.add({std::numeric_limits<double>::infinity(), 1.0, 1.0}), (Pose{1.0, 1.0, 1.0}));
}

}  // namespace
}  // namespace rovigo::slam
