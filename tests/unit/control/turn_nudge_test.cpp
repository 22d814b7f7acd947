#include "control/turn_nudge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "control/control_config.h"

namespace rovigo::control {
namespace {

constexpr double kDtS = 1.0 / 120.0;

DriveLimits limits() { return drive_limits(ControlConfig{}, maps::RobotModel{}); }

/// The highest turn rate that is commanded during the first push.
double peak_of_push(double error_rad, double dead_zone_m_s) {
  TurnNudge nudge;
  TTwist2D command;
  double peak = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double rate = nudge.step(error_rad, kDtS, dead_zone_m_s, 1.0, limits());
    command = limited_command({0, 0, rate}, command, kDtS, limits());
    peak = std::max(peak, std::abs(command.omega));
    if (peak > 0.0 && command.omega == 0.0) break;
  }
  return peak;
}

TEST(TurnNudge, EveryPushIsStrongEnoughToMoveAStandingWheel) {
  for (double dead_zone = 0.02; dead_zone <= 0.12; dead_zone += 0.005) {
    const double needed = 2.0 * dead_zone / limits().track_width_m;
    for (double error = 0.011; error < 0.2; error += 0.01) {
      EXPECT_GT(peak_of_push(error, dead_zone), needed) << error << " rad, " << dead_zone << " m/s";
      EXPECT_GT(peak_of_push(-error, dead_zone), needed) << -error << " rad, " << dead_zone;
    }
  }
}

TEST(TurnNudge, WaitsBetweenPushesForTheirEffectToBeSeen) {
  TurnNudge nudge;
  double rested_s = 0.0, shortest_s = 10.0;
  bool pushed = false;
  for (int i = 0; i < 1200; ++i) {
    if (nudge.step(0.05, kDtS, 0.04, 1.0, limits()) == 0.0) {
      rested_s += kDtS;
      continue;
    }
    if (pushed && rested_s > 0.0) shortest_s = std::min(shortest_s, rested_s);
    pushed = true;
    rested_s = 0.0;
  }
  EXPECT_TRUE(pushed);
  EXPECT_GE(shortest_s, 0.35);
  EXPECT_LT(shortest_s, 10.0);
}

}  // namespace
}  // namespace rovigo::control
