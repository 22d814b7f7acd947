#include "control/look_around.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace rovigo::control {
namespace {

constexpr double kStepS = 1.0 / 120;

struct Ending {
  TrackStatus status = TrackStatus::kRunning;
  double heading_rad = 0.0;
  double turned_rad = 0.0;  ///< either way, added up
  double took_s = 0.0;
};

/// A rover that turns as it is told and knows its pose where `knows` its heading.
Ending look_around(LookAround& search, const std::function<bool(double heading_rad)>& knows) {
  Ending end;
  while (end.status == TrackStatus::kRunning && end.took_s < 120.0) {
    PoseInput pose;
    pose.time_s = end.took_s;
    pose.map_from_base = {1.0, 2.0, maps::wrap_angle(end.heading_rad)};
    pose.quality = knows(end.heading_rad) ? PoseQuality::kGood : PoseQuality::kLost;
    const TrackerOutput out = search.step(end.took_s, pose);
    EXPECT_EQ(out.command.vx, 0.0);
    end.heading_rad += out.command.omega * kStepS;
    end.turned_rad += std::abs(out.command.omega) * kStepS;
    end.took_s += kStepS;
    end.status = out.status;
  }
  return end;
}

TEST(LookAround, DoesNotTurnWhereTheViewIsKnown) {
  LookAround search;
  const Ending end = look_around(search, [](double) { return true; });
  EXPECT_EQ(end.status, TrackStatus::kReached);
  EXPECT_EQ(end.turned_rad, 0.0);
}

TEST(LookAround, TurnsUntilTheViewIsKnown) {
  LookAround search;
  const Ending end = look_around(search, [](double heading) { return heading > 2.0; });
  EXPECT_EQ(end.status, TrackStatus::kReached);
  EXPECT_NEAR(end.heading_rad, 2.0, 0.05);
}

TEST(LookAround, TurnsBackToWhereItIsToFace) {
  LookAround search(0.0);
  bool known = false;
  const Ending end = look_around(search, [&](double heading) { return known |= heading > 2.0; });
  EXPECT_EQ(end.status, TrackStatus::kReached);
  EXPECT_NEAR(end.heading_rad, 0.0, 0.11);
}

TEST(LookAround, GivesUpOnceRoundAndSaysSo) {
  LookAround search;
  const Ending end = look_around(search, [](double) { return false; });
  EXPECT_EQ(end.status, TrackStatus::kPoseLost);
  EXPECT_GT(end.turned_rad, 2.0 * maps::kPi);
  EXPECT_LT(end.turned_rad, 3.0 * maps::kPi);
}

TEST(LookAround, IsNotFinishedByBeingHeld) {
  LookAround search;
  PoseInput lost;
  search.step(0.0, lost);
  for (double t = kStepS; t < 60.0; t += kStepS) {
    EXPECT_EQ(search.hold(t).command.omega, 0.0);
  }
  const TrackerOutput out = search.step(60.0, lost);
  EXPECT_EQ(out.status, TrackStatus::kRunning);
  EXPECT_EQ(out.command.omega, 0.0);  // it has yet to stand for its moment
}

}  // namespace
}  // namespace rovigo::control
