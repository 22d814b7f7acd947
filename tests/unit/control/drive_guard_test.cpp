#include "control/drive_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rovigo::control {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kStepS = 1.0 / 120;
const TTwist2D kSetPoint{0.3, 0.0, 0.1};

/// All is well at this time.
GuardInput well(double now_s) {
  GuardInput in;
  in.now_s = now_s;
  in.pose = {now_s, {1, 2, 3}, 0.01, PoseQuality::kGood};
  in.set_point = kSetPoint;
  in.battery_v = 11.1;
  return in;
}

class Guard : public testing::Test {
 protected:
  Guard() { EXPECT_EQ(guard_.pass(well(10.0)).vx, kSetPoint.vx); }

  /// Time from `from_s` on until the command is zero, when `spoil` changes every input.
  template <class Spoil>
  double time_to_zero(double from_s, const Spoil& spoil) {
    for (int i = 1; i < 1000; ++i) {
      GuardInput in = well(from_s + i * kStepS);
      spoil(in);
      const TTwist2D command = guard_.pass(in);
      if (command.vx == 0.0 && command.omega == 0.0) return in.now_s - from_s;
    }
    return 1e9;
  }
  DriveGuard guard_{ControlConfig(), 9.6};
};

TEST_F(Guard, PassesSetPointsOnWhileAllIsWell) {
  const TTwist2D command = guard_.pass(well(10.01));
  EXPECT_EQ(command.vx, kSetPoint.vx);
  EXPECT_EQ(command.omega, kSetPoint.omega);
  EXPECT_EQ(guard_.cause(), StopCause::kNone);
}

TEST_F(Guard, HoldsTheLastSetPointForAsLongAsTheWatchdogAllows) {
  const double t = time_to_zero(10.0, [](GuardInput& in) { in.set_point.reset(); });
  EXPECT_NEAR(t, 0.2, 1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kNoSetPoints);
}

TEST_F(Guard, StopsWhenPosesStallAndSaysSo) {
  const PoseInput last = well(10.0).pose;
  EXPECT_NEAR(time_to_zero(10.0, [&](GuardInput& in) { in.pose = last; }), 0.2, 1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kNoPoses);
}

TEST_F(Guard, StopsWhenPosesAreOldBadOrLostAndSaysWhich) {
  EXPECT_NEAR(time_to_zero(10.0, [](GuardInput& in) { in.pose.time_s -= 2.0; }), 0.2, 1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kOldPoses);
  guard_.pass(well(12.0));
  EXPECT_NEAR(time_to_zero(12.0, [](GuardInput& in) { in.pose.map_from_base.y = kNaN; }), 0.2,
              1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kBadPoses);
  guard_.pass(well(14.0));
  EXPECT_NEAR(time_to_zero(14.0, [](GuardInput& in) { in.pose.time_s = kNaN; }), 0.2, 1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kBadPoses);
  guard_.pass(well(16.0));
  EXPECT_NEAR(time_to_zero(16.0, [](GuardInput& in) { in.pose.quality = PoseQuality::kLost; }), 0.2,
              1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kLostPoses);
}

TEST_F(Guard, StopsAtOnceOnALowBatteryAndOnAManualTakeover) {
  EXPECT_NEAR(time_to_zero(10.0, [](GuardInput& in) { in.battery_v = 9.5; }), kStepS, 1e-9);
  EXPECT_EQ(guard_.cause(), StopCause::kLowBattery);
  guard_.pass(well(12.0));
  EXPECT_NEAR(time_to_zero(12.0, [](GuardInput& in) { in.battery_v = kNaN; }), kStepS, 1e-9);
  guard_.pass(well(14.0));
  EXPECT_NEAR(time_to_zero(14.0, [](GuardInput& in) { in.manual = true; }), kStepS, 1e-9);
  EXPECT_EQ(guard_.cause(), StopCause::kManual);
}

TEST_F(Guard, GoesOnAsSoonAsAllIsWellAgain) {
  time_to_zero(10.0, [](GuardInput& in) { in.set_point.reset(); });
  EXPECT_EQ(guard_.pass(well(11.0)).vx, kSetPoint.vx);
  EXPECT_EQ(guard_.cause(), StopCause::kNone);
}

TEST_F(Guard, SetPointsThatAreNoNumbersAreNone) {
  EXPECT_NEAR(time_to_zero(10.0, [](GuardInput& in) { in.set_point->omega = kNaN; }), 0.2, 1e-6);
  EXPECT_EQ(guard_.cause(), StopCause::kNoSetPoints);
}

TEST_F(Guard, APoseOvertakenOnItsWayFeedsNothing) {
  const double t =
      time_to_zero(10.0, [](GuardInput& in) { in.pose.time_s = 10.0 - in.now_s / 1e4; });
  EXPECT_NEAR(t, 0.2, 1e-6);
}

TEST_F(Guard, ClockThatRunsBackwardsStops) {
  EXPECT_EQ(guard_
                .pass([] {
                  GuardInput in = well(9.0);
                  in.set_point.reset();
                  return in;
                }())
                .vx,
            0.0);
}

TEST_F(Guard, PatienceEndsSoonerForFaultsThanForOperators) {
  const ControlConfig config;
  for (double t = 10.0; t < 100.0; t += kStepS) {
    GuardInput in = well(t);
    in.manual = true;
    guard_.pass(in);
    ASSERT_EQ(guard_.out_of_patience(t), t - 10.0 > config.takeover_patience_s) << t;
  }
  guard_.pass(well(100.0));
  EXPECT_FALSE(guard_.out_of_patience(100.0));
  for (double t = 100.0; t < 120.0; t += kStepS) {
    GuardInput in = well(t);
    in.battery_v = 1.0;
    guard_.pass(in);
    ASSERT_EQ(guard_.out_of_patience(t), t - 100.0 > config.pose_patience_s) << t;
  }
}

TEST(DriveGuard, BeforeTheFirstPoseNothingMoves) {
  DriveGuard guard(ControlConfig(), 0.0);
  GuardInput in = well(1.0);
  in.pose = {};
  EXPECT_EQ(guard.pass(in).vx, 0.0);
  in = well(2.0);
  in.pose = {};
  EXPECT_EQ(guard.pass(in).vx, 0.0);
  EXPECT_EQ(guard.cause(), StopCause::kNoPoses);
}

TEST_F(Guard, LetsARoverThatLooksForItsPoseTurnButNotDrive) {
  for (int i = 1; i < 600; ++i) {
    GuardInput in = well(10.0 + i * kStepS);
    in.pose.quality = PoseQuality::kLost;
    in.looks_around = true;
    const TTwist2D command = guard_.pass(in);
    EXPECT_EQ(command.vx, 0.0);
    EXPECT_EQ(command.omega, kSetPoint.omega);
  }
}

TEST_F(Guard, HoldsARoverThatLooksAroundOnALowBattery) {
  const double zero_s = time_to_zero(10.0, [](GuardInput& in) {
    in.looks_around = true;
    in.battery_v = 9.0;
  });
  EXPECT_NEAR(zero_s, kStepS, 1e-9);
}

}  // namespace
}  // namespace rovigo::control
