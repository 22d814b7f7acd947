#include "slam/tracking_health.h"

#include <gtest/gtest.h>

namespace rovigo::slam {
namespace {

constexpr double kFrameS = 1.0 / 15.0;

/// A rover whose camera delivers 15 frames a second.
struct Rover {
  TrackingHealth health;
  double time_s = 10.0;

  void sees(int frames, bool tracked, ViewVerdict verdict = ViewVerdict::kSilent) {
    for (int i = 0; i < frames; ++i, time_s += kFrameS) {
      health.update({.time_s = time_s, .tracked = tracked, .verdict = verdict});
    }
  }
  TrackingState state() const { return health.state(); }
};

TEST(TrackingHealth, AFrameThatMatchesIsTracked) {
  Rover rover;
  rover.sees(1, true);
  EXPECT_EQ(rover.state(), TrackingState::kTracking);
  EXPECT_TRUE(rover.health.is_trusted());
}

TEST(TrackingHealth, APlainCorridorIsReckonedThroughAndTrusted) {
  Rover rover;
  rover.sees(5, true);
  rover.sees(600, false, ViewVerdict::kSilent);
  EXPECT_EQ(rover.state(), TrackingState::kReckoning);
  EXPECT_TRUE(rover.health.is_trusted());
}

TEST(TrackingHealth, BlurWithTheRightDepthsIsNoContradiction) {
  Rover rover;
  rover.sees(5, true);
  rover.sees(60, false, ViewVerdict::kAgrees);
  EXPECT_EQ(rover.state(), TrackingState::kReckoning);
  EXPECT_TRUE(rover.health.is_trusted());
}

// A room entered backwards hides what was mapped from the door; nobody was carried anywhere.
TEST(TrackingHealth, AnUnbrokenViewIsNeverLost) {
  TrackingHealth health;
  health.update({.time_s = 1.0, .tracked = true});
  for (double t = 1.0 + kFrameS; t < 20.0; t += kFrameS) {
    const auto verdict = t < 10.0 ? ViewVerdict::kHidden : ViewVerdict::kContradicts;
    health.update({.time_s = t, .verdict = verdict, .continuous = true});
    ASSERT_EQ(health.state(), TrackingState::kReckoning);
    ASSERT_TRUE(health.is_trusted());
  }
}

TEST(TrackingHealth, OneBreakInTheViewIsRemembered) {
  TrackingHealth health;
  health.update({.time_s = 1.0, .tracked = true});
  health.update({.time_s = 1.0 + kFrameS, .verdict = ViewVerdict::kSilent, .continuous = false});
  double t = 1.0 + 2 * kFrameS;
  for (; t < 2.0; t += kFrameS) {
    health.update({.time_s = t, .verdict = ViewVerdict::kContradicts, .continuous = true});
  }
  EXPECT_EQ(health.state(), TrackingState::kLost);
}

TEST(TrackingHealth, AnotherPlaceIsLostWithinASecond) {
  Rover rover;
  rover.sees(5, true);
  const double put_down_s = rover.time_s;
  while (rover.state() != TrackingState::kLost && rover.time_s < put_down_s + 5.0) {
    rover.sees(1, false, ViewVerdict::kContradicts);
    EXPECT_FALSE(rover.health.is_trusted());
  }
  EXPECT_LT(rover.time_s - put_down_s, 1.0);
  EXPECT_NEAR(rover.health.doubted_since_s(), put_down_s, 1e-9);
}

TEST(TrackingHealth, AtThreeFramesASecondOneOddFrameIsNotEnough) {
  TrackingHealth health;
  health.update({.time_s = 1.0, .tracked = true});
  health.update({.time_s = 1.33, .verdict = ViewVerdict::kContradicts});
  health.update({.time_s = 2.0, .verdict = ViewVerdict::kContradicts});
  EXPECT_EQ(health.state(), TrackingState::kReckoning);
  health.update({.time_s = 2.33, .verdict = ViewVerdict::kContradicts});
  EXPECT_EQ(health.state(), TrackingState::kLost);
}

TEST(TrackingHealth, APersonWhoWalksByIsWaitedForButNothingIsMapped) {
  Rover rover;
  rover.sees(5, true);
  rover.sees(20, false, ViewVerdict::kHidden);
  EXPECT_EQ(rover.state(), TrackingState::kReckoning);
  EXPECT_FALSE(rover.health.is_trusted());
  rover.sees(1, true);
  EXPECT_EQ(rover.state(), TrackingState::kTracking);
}

TEST(TrackingHealth, AViewThatStaysHiddenIsLostInTheEnd) {
  Rover rover;
  rover.sees(5, true);
  rover.sees(60, false, ViewVerdict::kHidden);
  EXPECT_EQ(rover.state(), TrackingState::kLost);
}

TEST(TrackingHealth, TurnedOnStandingWheelsIsLostAtOnce) {
  TrackingHealth health;
  health.update({.time_s = 1.0, .tracked = true});
  health.update({.time_s = 1.1, .carried = true});
  EXPECT_EQ(health.state(), TrackingState::kLost);
}

TEST(TrackingHealth, ARecognisedPlaceIsTrustedOnlyAfterFramesConfirmIt) {
  Rover rover;
  rover.sees(5, true);
  rover.sees(20, false, ViewVerdict::kContradicts);
  rover.health.found_elsewhere();
  rover.sees(1, true);
  EXPECT_EQ(rover.state(), TrackingState::kConfirming);
  EXPECT_FALSE(rover.health.is_trusted());
  rover.sees(4, true);
  EXPECT_EQ(rover.state(), TrackingState::kTracking);
}

TEST(TrackingHealth, APlaceThatTheNextFrameDoesNotConfirmIsGivenUp) {
  Rover rover;
  rover.sees(5, true);
  rover.health.found_elsewhere();
  rover.sees(1, true);
  rover.sees(1, false, ViewVerdict::kContradicts);
  EXPECT_EQ(rover.state(), TrackingState::kLost);
}

TEST(TrackingHealth, APlaceFoundByOneViewMustBeConfirmedByFour) {
  Rover rover;
  rover.health.give_up();
  rover.health.found_elsewhere();
  rover.sees(3, true);
  EXPECT_EQ(rover.state(), TrackingState::kConfirming);
  EXPECT_FALSE(rover.health.is_trusted());
  rover.sees(1, true);
  EXPECT_EQ(rover.state(), TrackingState::kTracking);
}

TEST(TrackingHealth, APlaceFoundBySeveralViewsNeedsOneMore) {
  Rover rover;
  rover.health.give_up();
  rover.health.found_for_sure();
  EXPECT_FALSE(rover.health.is_trusted());
  rover.sees(1, true);
  EXPECT_EQ(rover.state(), TrackingState::kTracking);
  rover.health.give_up();
  rover.health.found_for_sure();
  rover.sees(1, false, ViewVerdict::kSilent);
  EXPECT_EQ(rover.state(), TrackingState::kLost);
}

}  // namespace
}  // namespace rovigo::slam
