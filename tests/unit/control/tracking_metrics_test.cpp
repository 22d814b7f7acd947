#include "control/tracking_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

planning::Trajectory straight() { return testing::TrajectoryBuilder({}, {}).line(2).get(); }

/// The plan driven exactly, but `offset` to its left.
DriveLog beside(const planning::Trajectory& plan, double offset) {
  DriveLog log;
  for (const auto& point : plan.points) {
    DriveStep s;
    s.time_s = point.time_s;
    s.reference = point;
    s.true_pose = {point.pose.x, point.pose.y + offset, point.pose.phi};
    s.estimated_pose = s.true_pose;
    s.command.vx = s.true_twist.vx = point.speed_m_s;
    log.steps.push_back(s);
  }
  return log;
}

TEST(TrackingMetrics, OffsetBecomesTheCrossTrackError) {
  const auto plan = straight();
  const DriveMetrics m = measure(beside(plan, 0.02), plan, {2, 0, 0}, true);
  EXPECT_NEAR(m.cross_track_rms_m, 0.02, 1e-9);
  EXPECT_NEAR(m.cross_track_max_m, 0.02, 1e-9);
  EXPECT_NEAR(m.along_track_rms_m, 0.0, 1e-9);
  EXPECT_NEAR(m.final_position_error_m, 0.02, 1e-9);
  EXPECT_NEAR(m.path_length_m, 2.0, 1e-6);
  EXPECT_NEAR(m.driven_length_m, 2.0, 1e-6);
  EXPECT_NEAR(m.duration_s, plan.duration_s(), 1e-9);
  EXPECT_GT(m.saturation_share, 0.5);  // most of it is at the highest speed
}

TEST(TrackingMetrics, HeadingErrorIsWrappedAndOnlyCountsWhenAsked) {
  const auto plan = straight();
  DriveLog log = beside(plan, 0.0);
  log.steps.back().true_pose.phi = maps::kPi - 0.1;
  const TPose2D goal(2, 0, -maps::kPi + 0.1);
  EXPECT_NEAR(measure(log, plan, goal, true).final_heading_error_rad, 0.2, 1e-9);
  EXPECT_EQ(measure(log, plan, goal, false).final_heading_error_rad, 0.0);
}

TEST(TrackingMetrics, CrossTrackHasItsSign) {
  const auto plan = straight();
  EXPECT_NEAR(cross_track_error_m(plan, {1, 0.3}), 0.3, 1e-9);
  EXPECT_NEAR(cross_track_error_m(plan, {1, -0.3}), -0.3, 1e-9);
  EXPECT_NEAR(cross_track_error_m(plan, {2.3, 0.4}), 0.5, 1e-6);  // past the end: to the end
}

TEST(TrackingMetrics, APlanOfOnePointIsItself) {
  planning::Trajectory one;
  one.points.push_back({});
  EXPECT_NEAR(std::abs(cross_track_error_m(one, {3, 4})), 5.0, 1e-12);
}

TEST(TrackingMetrics, AnEmptyLogGivesThePlansFigures) {
  const auto plan = straight();
  const DriveMetrics m = measure({}, plan, {2, 0, 0}, true);
  EXPECT_NEAR(m.path_length_m, 2.0, 1e-6);
  EXPECT_EQ(m.driven_length_m, 0.0);
  EXPECT_EQ(m.cross_track_max_m, 0.0);
}

TEST(TrackingMetrics, OvershootAndSettlingAreThoseAfterTheReferenceArrived) {
  const auto plan = straight();
  DriveLog log = beside(plan, 0.0);
  log.status = TrackStatus::kReached;
  // One second at the goal: 3 cm beyond it for half of it, then on it.
  for (int i = 1; i <= 100; ++i) {
    DriveStep s = log.steps.back();
    s.time_s = plan.duration_s() + 0.01 * i;
    s.true_pose.x = i <= 50 ? 2.03 : 2.0;
    s.command = {};
    log.steps.push_back(s);
  }
  const DriveMetrics m = measure(log, plan, {2, 0, 0}, true);
  EXPECT_NEAR(m.overshoot_m, 0.03, 1e-6);
  EXPECT_NEAR(m.settling_s, 0.5, 0.011);
  EXPECT_NEAR(m.time_ratio, 1.0 + 1.0 / plan.duration_s(), 1e-6);
  EXPECT_NEAR(m.spl, 2.0 / 2.06, 1e-3);
  log.contact_events = 1;
  EXPECT_EQ(measure(log, plan, {2, 0, 0}, true).spl, 0.0);
}

TEST(TrackingMetrics, JerkIsThatOfTheCommandedSpeed) {
  const auto plan = straight();
  DriveLog log;
  for (int i = 0; i < 400; ++i) {  // v = t^3 / 6: its jerk is t
    DriveStep s;
    s.time_s = 0.01 * i;
    s.command.vx = std::pow(s.time_s, 3) / 6.0;
    log.steps.push_back(s);
  }
  double mean_square = 0.0;
  for (int i = 0; i < 400; ++i) mean_square += std::pow(0.01 * i, 2) / 400.0;
  EXPECT_NEAR(measure(log, plan, {2, 0, 0}, true).jerk_rms_m_s3, std::sqrt(mean_square), 0.1);
  for (DriveStep& s : log.steps) s.command.vx = 0.4;
  EXPECT_NEAR(measure(log, plan, {2, 0, 0}, true).jerk_rms_m_s3, 0.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::control
