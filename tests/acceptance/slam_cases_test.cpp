// SLAM on each hard case, a short drive each; full_slam_cases_test.cpp drives them at full length.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/slam_case_test.h"

namespace {

using namespace rovigo::test;

/// The case without figures that a short drive cannot give; full_slam_cases_test.cpp asks for all.
SlamCase without(SlamCase c, std::vector<SlamScore::Value SlamScore::*> figures) {
  std::erase_if(c.checks, [&](const Check& check) {
    return std::find(figures.begin(), figures.end(), check.figure) != figures.end();
  });
  return c;
}

void expect_short_drive_holds(const SlamCase& c, std::size_t number = 0) {
  expect_checks_hold(c, {record_and_score(c, c.quick.at(number))});
}

TEST(SlamShortDrive, MapsAnOffice) {
  // Within 8 m much ground is seen once and from afar: free space is asked for at full length.
  expect_short_drive_holds(without(slam_case("office_loop"), {&SlamScore::free_iou_in_view}));
}

TEST(SlamShortDrive, MeasuresItsWayIntoAPlainCorridor) {
  expect_short_drive_holds(without(slam_case("plain_corridor"), {&SlamScore::length_error}));
}

TEST(SlamShortDrive, TakesNoChangeOfLightForMotion) {
  expect_short_drive_holds(slam_case("light_steps"));
}

TEST(SlamShortDrive, SaysThatTheCameraIsCoveredAndComesBack) {
  expect_short_drive_holds(slam_case("blackouts"), 0);
}

TEST(SlamShortDrive, SaysThatFramesAreMissingAndComesBack) {
  // That it says so at once is asked at full length: SLAM answers to camera frames only, so far.
  expect_short_drive_holds(without(slam_case("blackouts"), {&SlamScore::not_ok_after_s}), 1);
}

TEST(SlamShortDrive, SaysThatItIsLostWhenCarriedOffAndFindsItself) {
  expect_short_drive_holds(slam_case("kidnap"));
}

TEST(SlamShortDrive, TurnsInPlaceWithBlurredImages) {
  expect_short_drive_holds(slam_case("turns_with_blur"));
}

TEST(SlamShortDrive, IsNotLedAstrayByPeopleWhoWalkBy) {
  // Ghosts are asked for at full length: here the rover turns away from people who still stand
  // there.
  expect_short_drive_holds(without(slam_case("people"), {&SlamScore::ghost_cells}));
}

TEST(SlamShortDrive, MapsAGlossyFloorAsFree) {
  // As in MapsAnOffice.
  expect_short_drive_holds(without(slam_case("glossy_floor"), {&SlamScore::free_iou_in_view}));
}

}  // namespace
