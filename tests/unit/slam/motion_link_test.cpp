#include "slam/motion_link.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rovigo::slam {
namespace {

constexpr double kStepS = 0.02;

/// A drive along an arc, as the sensors tell it.
std::vector<MotionStep> arc(double begin_s, double seconds, double speed, double turn_rate) {
  std::vector<MotionStep> steps;
  const int n = static_cast<int>(std::lround(seconds / kStepS));
  for (int i = 0; i < n; ++i) {
    steps.push_back({.begin_s = begin_s + i * kStepS,
                     .end_s = begin_s + (i + 1) * kStepS,
                     .distance_m = speed * kStepS,
                     .turn_rad = turn_rate * kStepS,
                     .has_gyro = true});
  }
  return steps;
}

MotionLink link_over(const std::vector<MotionStep>& steps, const MotionCalibration& calibration) {
  MotionLinks links{DeadReckoningConfig{}};
  links.mark(0, steps.front().begin_s, calibration);
  for (const MotionStep& s : steps) links.add(s);
  links.mark(1, steps.back().end_s, calibration);
  links.add({.begin_s = steps.back().end_s, .end_s = steps.back().end_s + kStepS});
  EXPECT_EQ(links.links().size(), 1u);
  return links.links().front();
}

TEST(MotionLink, AnArcEndsWhereGeometryPutsIt) {
  const MotionLink link = link_over(arc(5.0, 2.0, 0.4, 0.5), MotionCalibration::Zero());
  EXPECT_NEAR(link.from_from_to.x, 0.4 / 0.5 * std::sin(1.0), 1e-4);
  EXPECT_NEAR(link.from_from_to.y, 0.4 / 0.5 * (1.0 - std::cos(1.0)), 1e-4);
  EXPECT_NEAR(link.from_from_to.phi, 1.0, 1e-9);
}

TEST(MotionLink, AnotherCalibrationIsFollowedToFirstOrder) {
  const auto steps = arc(5.0, 2.0, 0.4, 0.5);
  const MotionCalibration other(0.002, 0.02, 0.0, 0.0);
  const TPose2D predicted = link_over(steps, MotionCalibration::Zero()).under(other);
  const TPose2D exact = link_over(steps, other).from_from_to;
  EXPECT_NEAR(predicted.x, exact.x, 2e-4);
  EXPECT_NEAR(predicted.y, exact.y, 2e-4);
  EXPECT_NEAR(predicted.phi, exact.phi, 1e-9);
}

TEST(MotionLink, AGyroThatTellsLateOwesTheTurnsBegin) {
  std::vector<MotionStep> steps = arc(5.0, 1.0, 0.0, 0.0);
  for (std::size_t i = 25; i < steps.size(); ++i) steps[i].turn_rad = 1.2 * kStepS;
  steps[25].turn_rate_change_rad_s = 1.2;
  const MotionCalibration late(0.0, 0.0, 0.0, 0.01);
  const MotionLink link = link_over(steps, late);
  EXPECT_NEAR(link.from_from_to.phi, 0.6 + 0.012, 1e-9);
  EXPECT_NEAR(link_over(steps, MotionCalibration::Zero()).under(late).phi, link.from_from_to.phi,
              1e-9);
}

TEST(MotionLink, AKeyframeBetweenTwoReadingsSplitsTheStep) {
  MotionLinks links{DeadReckoningConfig{}};
  links.mark(0, 1.0, MotionCalibration::Zero());
  links.mark(1, 1.25, MotionCalibration::Zero());
  links.mark(2, 2.0, MotionCalibration::Zero());
  links.add({.begin_s = 1.0, .end_s = 2.0, .distance_m = 0.4});
  links.add({.begin_s = 2.0, .end_s = 2.02});
  ASSERT_EQ(links.links().size(), 2u);
  EXPECT_NEAR(links.links()[0].from_from_to.x, 0.1, 1e-12);
  EXPECT_NEAR(links.links()[1].from_from_to.x, 0.3, 1e-12);
}

TEST(MotionLink, NothingTiesWhatACutHasParted) {
  MotionLinks links{DeadReckoningConfig{}};
  links.mark(0, 1.0, MotionCalibration::Zero());
  links.add({.begin_s = 1.0, .end_s = 1.5, .distance_m = 0.2});
  links.cut();
  links.add({.begin_s = 1.5, .end_s = 2.0, .distance_m = 0.2});
  links.mark(1, 2.0, MotionCalibration::Zero());
  links.add({.begin_s = 2.0, .end_s = 2.5, .distance_m = 0.2});
  EXPECT_TRUE(links.links().empty());
}

TEST(MotionLink, SilenceOfTheWheelsCostsCertainty) {
  const auto steps = arc(5.0, 1.0, 0.4, 0.0);
  const double without_gap = link_over(steps, MotionCalibration::Zero()).covariance.trace();
  auto with_gap = steps;
  for (std::size_t i = 10; i < with_gap.size(); ++i) {
    with_gap[i].begin_s += 1.0;
    with_gap[i].end_s += 1.0;
  }
  EXPECT_GT(link_over(with_gap, MotionCalibration::Zero()).covariance.trace(), 100.0 * without_gap);
}

TEST(MotionLink, ASlippingWheelIsTrustedLess) {
  const auto steps = arc(5.0, 1.0, 0.4, 0.0);
  auto slipping = steps;
  for (MotionStep& s : slipping) s.slipping = true;
  EXPECT_GT(link_over(slipping, MotionCalibration::Zero()).covariance(0, 0),
            link_over(steps, MotionCalibration::Zero()).covariance(0, 0));
}

}  // namespace
}  // namespace rovigo::slam
