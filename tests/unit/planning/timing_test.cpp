#include "planning/timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "planning/check.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

const MotionLimits kLimits{.speed_m_s = 0.4,
                           .yaw_rate_rad_s = 1.0,
                           .acceleration_m_s2 = 0.4,
                           .yaw_acceleration_rad_s2 = 1.6,
                           .lateral_acceleration_m_s2 = 0.25,
                           .wheel_speed_m_s = 0.8,
                           .track_width_m = 0.358};

PathPiece straight(const TPoint2D& a, const TPoint2D& b, bool slow = false) {
  return {.curve = CubicBSpline::uniform({a, b}), .slow = slow};
}

PathPiece circle(double radius_m, double angle_rad) {
  std::vector<TPoint2D> points;
  const int n = static_cast<int>(angle_rad * radius_m / 0.05);
  for (int i = 0; i <= n; ++i) {
    const double a = angle_rad * i / n;
    points.push_back({radius_m * std::sin(a), radius_m * (1.0 - std::cos(a))});
  }
  return {.curve = CubicBSpline::uniform(points)};
}

Trajectory timed(std::vector<PathPiece> pieces, std::optional<double> start = std::nullopt,
                 std::optional<double> goal = std::nullopt) {
  TimingProblem problem;
  problem.pieces = std::move(pieces);
  problem.start_heading_rad = start;
  problem.goal_heading_rad = goal;
  return time_path(problem, kLimits, {});
}

void expect_sound(const Trajectory& trajectory) {
  const auto grid = grid_of({"..", ".."}, 100.0);
  auto shifted = trajectory;  // into the middle of an empty world
  for (auto& p : shifted.points) {
    p.pose.x += 50.0;
    p.pose.y += 50.0;
  }
  const auto report = check(shifted, grid, {.robot_radius_m = 0.3, .limits = kLimits});
  EXPECT_THAT(report.problems, testing::IsEmpty());
}

TEST(Timing, StraightLineTakesTheTimeOfATrapezoid) {
  const auto trajectory = timed({straight({0, 0}, {3, 0})});
  // v / a to speed up and again to stop, the rest of the way at v.
  EXPECT_NEAR(trajectory.duration_s(), 3.0 / 0.4 + 0.4 / 0.4, 0.02);
  EXPECT_NEAR(length_m(trajectory), 3.0, 1e-9);
  expect_sound(trajectory);
}

TEST(Timing, AShortLineNeverReachesFullSpeed) {
  const auto trajectory = timed({straight({0, 0}, {0.1, 0})});
  EXPECT_NEAR(trajectory.duration_s(), 2.0 * std::sqrt(0.1 / 0.4), 0.02);
  expect_sound(trajectory);
}

TEST(Timing, AMillimetreIsStillATrajectory) {
  const auto trajectory = timed({straight({0, 0}, {0.001, 0})});
  EXPECT_GE(trajectory.points.size(), 3U);
  EXPECT_EQ(trajectory.points.back().pose.x, 0.001);
  expect_sound(trajectory);
}

TEST(Timing, BendsAreDrivenAsFastAsTheirLateralAccelerationAllows) {
  const auto trajectory = timed({circle(0.4, 3.0)});
  const auto middle = sample(trajectory, 0.5 * trajectory.duration_s());
  EXPECT_NEAR(middle.speed_m_s, std::sqrt(0.25 * 0.4), 5e-3);
  EXPECT_NEAR(middle.yaw_rate_rad_s, middle.speed_m_s / 0.4, 0.02);
  EXPECT_NEAR(middle.curvature_1_m, 2.5, 0.02);
  expect_sound(trajectory);
}

TEST(Timing, SlowPiecesAreSlow) {
  const auto trajectory = timed({straight({0, 0}, {1, 0}, true), straight({1, 0}, {2, 0})});
  double fastest_before = 0.0;
  double fastest_after = 0.0;
  for (const auto& p : trajectory.points) {
    auto& fastest = p.pose.x <= 1.0 ? fastest_before : fastest_after;
    fastest = std::max(fastest, p.speed_m_s);
  }
  EXPECT_NEAR(fastest_before, TimingConfig().escape_speed_m_s, 1e-9);
  EXPECT_NEAR(fastest_after, 0.4, 1e-9);
  expect_sound(trajectory);
}

TEST(Timing, TurnsFirstWhenItFacesElsewhere) {
  const auto trajectory = timed({straight({0, 0}, {1, 0})}, 2.0);
  EXPECT_EQ(trajectory.points.front().pose.phi, 2.0);
  // 2 rad at 1 rad/s with 1.6 rad/s^2, then the line.
  const auto after_turn = sample(trajectory, 2.0 + 1.0 / 1.6);
  EXPECT_NEAR(after_turn.pose.phi, 0.0, 0.02);
  EXPECT_NEAR(after_turn.pose.x, 0.0, 1e-3);
  expect_sound(trajectory);
}

TEST(Timing, TurnsTheShortWayRound) {
  const auto trajectory = timed({straight({0, 0}, {-1, -0.01})}, 3.0);
  for (const auto& p : trajectory.points) EXPECT_GT(std::abs(p.pose.phi), 2.9);
  expect_sound(trajectory);
}

TEST(Timing, EndsWithTheHeadingAskedFor) {
  const auto trajectory = timed({straight({0, 0}, {1, 0})}, 0.0, -1.2);
  EXPECT_NEAR(trajectory.points.back().pose.phi, -1.2, 1e-12);
  EXPECT_EQ(trajectory.points.back().speed_m_s, 0.0);
  EXPECT_EQ(trajectory.points.back().yaw_rate_rad_s, 0.0);
  expect_sound(trajectory);
}

TEST(Timing, WithoutAWayItOnlyTurns) {
  TimingProblem problem;
  problem.at = {1.0, 2.0};
  problem.start_heading_rad = 0.0;
  problem.goal_heading_rad = 1.0;
  const auto trajectory = time_path(problem, kLimits, {});
  ASSERT_GT(trajectory.points.size(), 10U);
  for (const auto& p : trajectory.points) EXPECT_EQ(p.pose.x, 1.0);
  EXPECT_NEAR(trajectory.points.back().pose.phi, 1.0, 1e-12);
  expect_sound(trajectory);
}

TEST(Timing, CornersBetweenPiecesAreTurnedAtInPlace) {
  const auto trajectory = timed({straight({0, 0}, {1, 0}), straight({1, 0}, {1, 1})});
  bool turned_at_corner = false;
  for (const auto& p : trajectory.points) {
    if (p.speed_m_s == 0.0 && std::abs(p.yaw_rate_rad_s) > 0.5) {
      EXPECT_NEAR(p.pose.x, 1.0, 1e-9);
      EXPECT_NEAR(p.pose.y, 0.0, 1e-9);
      turned_at_corner = true;
    }
  }
  EXPECT_TRUE(turned_at_corner);
  expect_sound(trajectory);
}

TEST(Timing, WheelSpeedLimitsTightBends) {
  MotionLimits limits = kLimits;
  limits.wheel_speed_m_s = 0.2;
  TimingProblem problem;
  problem.pieces = {circle(0.3, 3.0)};
  const auto trajectory = time_path(problem, limits, {});
  const auto middle = sample(trajectory, 0.5 * trajectory.duration_s());
  EXPECT_NEAR(middle.speed_m_s + 0.5 * 0.358 * middle.yaw_rate_rad_s, 0.2, 5e-3);
}

}  // namespace
}  // namespace rovigo::planning
