#include "control/reference_drive.h"

#include <gtest/gtest.h>

#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

PoseInput good(double time_s, const TPose2D& pose) {
  return {time_s, pose, 0.0, PoseQuality::kGood};
}

TEST(ReferenceDrive, CutsThePathIntoEvenSegmentsAndGivesTurnsInPlaceNone) {
  const auto plan = testing::square({});
  const auto points = evenly_spaced(plan, 100);
  ASSERT_EQ(points.size(), 101U);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step =
        maps::distance(maps::position_of(points[i - 1].pose), maps::position_of(points[i].pose));
    EXPECT_NEAR(step, 0.06, 0.001) << i;
  }
}

TEST(ReferenceDrive, StepsAHundredTimesASecondHoweverOftenItIsAsked) {
  ReferenceDrive drive({}, testing::moderate_curve({}), 60.0);
  int changes = 0;
  double last = -1.0;
  for (int i = 0; i < 240; ++i) {
    const TPose2D pose(1e-6 * i, 0, 0);  // every step sees a new pose
    const double v = drive.step(i / 240.0, good(i / 240.0, pose)).heading_error_rad;
    changes += v != last ? 1 : 0;
    last = v;
  }
  EXPECT_NEAR(changes, 100, 1);
}

TEST(ReferenceDrive, EndsWhenTheTimeIsUpAndStandsThen) {
  ReferenceDrive drive({}, testing::moderate_curve({}), 1.0);
  TrackerOutput out;
  for (int i = 0; i < 200; ++i) out = drive.step(i / 100.0, good(i / 100.0, {0, 0, 0}));
  EXPECT_EQ(out.status, TrackStatus::kTimedOut);
  EXPECT_EQ(out.command.vx, 0.0);
}

TEST(ReferenceDrive, ArrivesAtTheEndOfItsPath) {
  const auto plan = testing::moderate_curve({});
  testing::Plant plant({}, {});
  ReferenceDrive drive({}, plan, 60.0);
  TrackerOutput out;
  while (out.status == TrackStatus::kRunning) {
    out = drive.step(plant.time_s(), good(plant.time_s(), plant.pose()));
    plant.step(out.command, 0.01);
  }
  EXPECT_EQ(out.status, TrackStatus::kReached);
  EXPECT_LT(
      maps::distance(maps::position_of(plant.pose()), maps::position_of(plan.points.back().pose)),
      0.25);
}

}  // namespace
}  // namespace rovigo::control
