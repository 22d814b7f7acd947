#include "control/docking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace rovigo::control {
namespace {

constexpr double kStepS = 1.0 / 120.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A rover that does what it is told at once, but for a speed that something adds, and stiction.
struct Rover {
  TPose2D pose;
  double added_speed_m_s = 0.0;
  double dead_zone_m_s = 0.0;

  void move(const TTwist2D& command) {
    const double rim = std::abs(command.vx) + std::abs(command.omega) * 0.179;
    const bool sticks = rim < dead_zone_m_s;
    const double v = sticks ? 0.0 : command.vx + (command.vx != 0.0 ? added_speed_m_s : 0.0);
    const double w = sticks ? 0.0 : command.omega;
    pose.x += v * kStepS * std::cos(pose.phi + w * kStepS / 2);
    pose.y += v * kStepS * std::sin(pose.phi + w * kStepS / 2);
    pose.phi = maps::wrap_angle(pose.phi + w * kStepS);
  }
};

struct Docking {
  TrackStatus status = TrackStatus::kRunning;
  double time_s = 0.0;
  double farthest_m = -1e9;
  int attempts = 0;
  std::vector<TTwist2D> commands;
};

Docking dock(Rover& rover, const DockingConfig& config = {},
             const std::function<PoseInput(double, const TPose2D&)>& seen = {}) {
  DockingController controller(config, ControlConfig(), maps::RobotModel());
  Docking out;
  for (; out.status == TrackStatus::kRunning && out.time_s < 200.0; out.time_s += kStepS) {
    PoseInput pose{out.time_s, rover.pose, 0.01, PoseQuality::kGood};
    if (seen) pose = seen(out.time_s, rover.pose);
    const TrackerOutput step = controller.step(out.time_s, pose);
    out.status = step.status;
    out.commands.push_back(step.command);
    rover.move(step.command);
    out.farthest_m = std::max(out.farthest_m, rover.pose.x);
  }
  out.attempts = controller.attempts();
  return out;
}

TEST(DockingController, ComesToAStopAtTheDockFromStartsBesideItsAxis) {
  for (const double y : {-0.4, -0.1, 0.0, 0.3}) {
    for (const double yaw : {-0.4, 0.0, 0.3}) {
      SCOPED_TRACE(testing::Message() << y << " " << yaw);
      Rover rover{{-2.0, y, yaw}, 0.0, 0.0};
      const Docking out = dock(rover);
      EXPECT_EQ(out.status, TrackStatus::kReached);
      EXPECT_LE(std::abs(rover.pose.x), 0.016);
      EXPECT_LE(std::abs(rover.pose.y), 0.012);
      EXPECT_LE(std::abs(rover.pose.phi), 0.0121);
      EXPECT_LE(out.farthest_m, 0.001);  // a wall stands there
    }
  }
}

TEST(DockingController, WithoutTheIntegratorAnOpposingDisturbanceKeepsItOutForGood) {
  DockingConfig config;
  Rover hindered{{-1.5, 0.0, 0.0}, -0.03, 0.0};
  EXPECT_EQ(dock(hindered, config).status, TrackStatus::kReached);
  config.ki_1_s2 = 0.0;
  Rover helpless{{-1.5, 0.0, 0.0}, -0.03, 0.0};
  EXPECT_EQ(dock(helpless, config).status, TrackStatus::kTimedOut);
  EXPECT_NEAR(helpless.pose.x, -0.03 / config.kp_1_s, 0.002);
}

TEST(DockingController, ADisturbanceTooLargeForTheBoxKeepsItOutAndItSaysSo) {
  Rover rover{{-1.5, 0.0, 0.0}, -0.25, 0.0};  // stands at 0.25 / kp, outside the box
  const Docking out = dock(rover);
  EXPECT_EQ(out.status, TrackStatus::kTimedOut);
  EXPECT_LT(rover.pose.x, -0.2);
}

TEST(DockingController, StictionIsOvercome) {
  Rover rover{{-1.5, 0.2, 0.1}, 0.0, 0.02};
  const Docking out = dock(rover);
  EXPECT_EQ(out.status, TrackStatus::kReached);
  EXPECT_LE(std::hypot(rover.pose.x, rover.pose.y), 0.02);
}

TEST(DockingController, TooFarBesideItBacksUpAndTriesAgainAndGivesUpAfterTheLastAttempt) {
  Rover rover{{-0.35, 0.3, 0.0}, 0.0, 0.0};  // no way to get onto the axis in 35 cm
  const Docking out = dock(rover);
  EXPECT_EQ(out.status, TrackStatus::kReached);
  EXPECT_GT(out.attempts, 1);

  DockingConfig once;
  once.most_attempts = 1;
  Rover hopeless{{-0.35, 0.3, 0.0}, 0.0, 0.0};
  EXPECT_EQ(dock(hopeless, once).status, TrackStatus::kNoProgress);
}

TEST(DockingController, CommandsKeepWithinSpeedTurnRateAndAccelerations) {
  const maps::RobotModel robot;
  Rover rover{{-2.0, 0.4, -0.3}, 0.0, 0.0};
  const Docking out = dock(rover);
  TTwist2D last;
  for (const TTwist2D& c : out.commands) {
    EXPECT_LE(std::abs(c.vx), robot.max_speed_m_s + 1e-9);
    EXPECT_LE(std::abs(c.omega), robot.max_yaw_rate_rad_s + 1e-9);
    if (c.vx != 0.0 || c.omega != 0.0) {
      EXPECT_LE(std::abs(c.vx - last.vx), robot.max_acceleration_m_s2 * kStepS + 1e-9);
      EXPECT_LE(std::abs(c.omega - last.omega), robot.max_yaw_acceleration_rad_s2 * kStepS + 1e-9);
    }
    last = c;
  }
}

TEST(DockingController, StandsWhileItSeesNothingAndGivesUpWhenPatienceEnds) {
  Rover rover{{-1.5, 0.0, 0.0}, 0.0, 0.0};
  const Docking out = dock(rover, {}, [](double t, const TPose2D& pose) {
    PoseInput in{t, pose, 0.01, PoseQuality::kGood};
    if (t > 2.0) in.quality = PoseQuality::kLost;
    return in;
  });
  EXPECT_EQ(out.status, TrackStatus::kPoseLost);
  EXPECT_NEAR(out.time_s, 2.0 + ControlConfig().pose_patience_s, 0.1);
  for (std::size_t i = static_cast<std::size_t>(3.0 / kStepS); i < out.commands.size(); ++i) {
    EXPECT_EQ(out.commands[i].vx, 0.0);
  }
}

TEST(DockingController, PosesThatAreNoNumbersMoveNothing) {
  Rover rover{{-1.5, 0.0, 0.0}, 0.0, 0.0};
  dock(rover, {}, [](double t, const TPose2D&) {
    return PoseInput{t, {kNan, 0.0, 0.0}, 0.01, PoseQuality::kGood};
  });
  EXPECT_EQ(rover.pose.x, -1.5);
}

TEST(DockingController, TimeHeldByTheDriveSideDoesNotCount) {
  DockingConfig config;
  config.longest_s = 5.0;
  DockingController controller(config, ControlConfig(), maps::RobotModel());
  const PoseInput pose{0.0, {-1.5, 0.0, 0.0}, 0.01, PoseQuality::kGood};
  EXPECT_EQ(controller.step(0.0, pose).status, TrackStatus::kRunning);
  for (double t = kStepS; t < 60.0; t += kStepS) {
    const TrackerOutput held = controller.hold(t);
    EXPECT_EQ(held.command.vx, 0.0);
    EXPECT_EQ(held.status, TrackStatus::kRunning);
  }
}

}  // namespace
}  // namespace rovigo::control
