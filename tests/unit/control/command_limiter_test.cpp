#include "control/command_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::control {
namespace {

TEST(CommandLimiter, NeverReverses) {
  const TTwist2D out = limited_command({-0.3, 0, 0}, {0, 0, 0}, 0.1, {});
  EXPECT_EQ(out.vx, 0.0);
}

TEST(CommandLimiter, SpeedsUpAndSlowsDownWithinTheAccelerations) {
  const TTwist2D up = limited_command({0.4, 0, 1.0}, {0, 0, 0}, 0.01, {});
  EXPECT_NEAR(up.vx, 0.005, 1e-12);
  EXPECT_NEAR(up.omega, 0.02, 1e-12);
  const TTwist2D down = limited_command({0, 0, 0}, {0.4, 0, -1.0}, 0.01, {});
  EXPECT_NEAR(down.vx, 0.395, 1e-12);
  EXPECT_NEAR(down.omega, -0.98, 1e-12);
}

TEST(CommandLimiter, TurningComesBeforeSpeedAtTheRim) {
  DriveLimits limits;
  limits.max_speed_m_s = 0.8;
  TTwist2D command;
  for (int i = 0; i < 1000; ++i) command = limited_command({0.8, 0, 1.0}, command, 0.01, limits);
  EXPECT_NEAR(command.omega, 1.0, 1e-12);
  EXPECT_NEAR(command.vx + command.omega * limits.track_width_m / 2, limits.max_wheel_speed_m_s,
              1e-12);
}

TEST(CommandLimiter, TakesNonsenseForStandstill) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const TTwist2D wanted : {TTwist2D(kNan, 0, 0), TTwist2D(0.2, 0, kNan),
                                TTwist2D(std::numeric_limits<double>::infinity(), 0, 0)}) {
    const TTwist2D out = limited_command(wanted, {0.2, 0, 0.2}, 0.1, {});
    EXPECT_LT(out.vx, 0.2);
    EXPECT_LT(out.omega, 0.2);
  }
  const TTwist2D held = limited_command({0.4, 0, 0.4}, {0.2, 0, 0.2}, kNan, {});
  EXPECT_EQ(held.vx, 0.2);
  EXPECT_EQ(held.omega, 0.2);
}

TEST(DriveLimits, TakeTheRobotsFiguresAndTheRimSpeed) {
  maps::RobotModel robot;
  robot.max_speed_m_s = 0.8;
  robot.max_yaw_rate_rad_s = 3.0;
  ControlConfig config;
  config.max_wheel_speed_m_s = 0.358;
  const DriveLimits limits = drive_limits(config, robot);
  EXPECT_EQ(limits.max_speed_m_s, 0.358);
  EXPECT_NEAR(limits.max_yaw_rate_rad_s, 2.0, 1e-12);
}

TEST(DeadZone, StartsAStandingRoverOnTheCurveItWants) {
  const TTwist2D out = with_dead_zone_compensation({0.02, 0, 0.05}, 1.0, 0.05, 0.358);
  EXPECT_NEAR(out.vx + out.omega * 0.179, 0.05, 1e-12);
  EXPECT_NEAR(out.omega / out.vx, 2.5, 1e-9);
  const TTwist2D turn = with_dead_zone_compensation({0, 0, -0.1}, 1.0, 0.05, 0.358);
  EXPECT_EQ(turn.vx, 0.0);
  EXPECT_NEAR(turn.omega * 0.179, -0.05, 1e-12);
}

TEST(DeadZone, LeavesRollingRoversStandstillAndLargeCommandsAlone) {
  EXPECT_EQ(with_dead_zone_compensation({0.02, 0, 0}, 0.1, 0.05, 0.358).vx, 0.02);
  EXPECT_EQ(with_dead_zone_compensation({0, 0, 0}, 1.0, 0.05, 0.358).vx, 0.0);
  EXPECT_EQ(with_dead_zone_compensation({0.002, 0, 0}, 1.0, 0.05, 0.358).vx, 0.002);
  EXPECT_EQ(with_dead_zone_compensation({0.3, 0, 0.2}, 1.0, 0.05, 0.358).vx, 0.3);
  EXPECT_EQ(with_dead_zone_compensation({0.03, 0, 0}, 1.0, 0.0, 0.358).vx, 0.03);
}

}  // namespace
}  // namespace rovigo::control
