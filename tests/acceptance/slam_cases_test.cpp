// SLAM on each hard case, a short drive each; full_slam_cases_test.cpp drives them at full length.

#include <gtest/gtest.h>

#include "tests/support/slam_case_test.h"

namespace {

using namespace rovigo::test;

/// A corridor seen in part has no length, a drive without a corridor neither.
SlamCase without(SlamCase c, SlamScore::Value SlamScore::*figure) {
  std::erase_if(c.checks, [&](const Check& check) { return check.figure == figure; });
  return c;
}

void expect_short_drive_holds(const SlamCase& c, std::size_t number = 0) {
  expect_checks_hold(c, {record_and_score(c, c.quick.at(number))});
}

TEST(SlamShortDrive, MapsAnOffice) { expect_short_drive_holds(slam_case("office_loop")); }

TEST(SlamShortDrive, MeasuresItsWayIntoAPlainCorridor) {
  expect_short_drive_holds(without(slam_case("plain_corridor"), &SlamScore::length_error));
}

TEST(SlamShortDrive, TakesNoChangeOfLightForMotion) {
  expect_short_drive_holds(slam_case("light_steps"));
}

TEST(SlamShortDrive, SaysThatTheCameraIsCoveredAndComesBack) {
  expect_short_drive_holds(slam_case("blackouts"), 0);
}

TEST(SlamShortDrive, SaysThatFramesAreMissingAndComesBack) {
  expect_short_drive_holds(slam_case("blackouts"), 1);
}

TEST(SlamShortDrive, SaysThatItIsLostWhenCarriedOffAndFindsItself) {
  expect_short_drive_holds(slam_case("kidnap"));
}

TEST(SlamShortDrive, TurnsInPlaceWithBlurredImages) {
  expect_short_drive_holds(slam_case("turns_with_blur"));
}

TEST(SlamShortDrive, LeavesNoGhostOfPeopleWhoWalkBy) {
  expect_short_drive_holds(slam_case("people"));
}

TEST(SlamShortDrive, MapsAGlossyFloorAsFree) {
  expect_short_drive_holds(slam_case("glossy_floor"));
}

}  // namespace
