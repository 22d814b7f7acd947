#include "control/trajectory_legs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "control/approach.h"
#include "maps/error.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

using testing::TrajectoryBuilder;

planning::TrajectoryPoint at_time(double time_s) {
  planning::TrajectoryPoint p;
  p.time_s = time_s;
  return p;
}

TEST(TrajectoryLegs, CutsASquareIntoSidesAndTurns) {
  const TrajectoryLegs legs(testing::square({}));
  ASSERT_EQ(legs.legs().size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(legs.legs()[i].kind, i % 2 == 0 ? LegKind::kDrive : LegKind::kTurn) << i;
  }
  EXPECT_NEAR(legs.end_arc_m(legs.legs()[2]), 3.0, 1e-6);
}

TEST(TrajectoryLegs, CutsAtRestsBetweenDrivenStretches) {
  const TrajectoryLegs legs(TrajectoryBuilder({}, {}).line(1).line(1).get());
  EXPECT_EQ(legs.legs().size(), 2u);
}

TEST(TrajectoryLegs, ATrajectoryThatNeverMovesHasNoLegs) {
  planning::Trajectory still;
  still.points = {at_time(0), at_time(1)};
  EXPECT_TRUE(TrajectoryLegs(still).legs().empty());
}

TEST(TrajectoryLegs, ProjectsWithTheSignLeftOfTheDirectionOfTravel) {
  const TrajectoryLegs legs(TrajectoryBuilder({}, {}).line(2).get());
  const PathPlace place = legs.project({0.7, 0.1}, legs.legs()[0], 0.5, {});
  EXPECT_NEAR(place.arc_m, 0.7, 1e-9);
  EXPECT_NEAR(place.cross_track_m, 0.1, 1e-9);
  EXPECT_NEAR(legs.project({0.7, -0.1}, legs.legs()[0], 0.5, {}).cross_track_m, -0.1, 1e-9);
}

TEST(TrajectoryLegs, KnowsHowFarBeyondAnEndAPointLies) {
  const TrajectoryLegs legs(TrajectoryBuilder({}, {}).line(2).get());
  EXPECT_NEAR(legs.project({2.3, 0}, legs.legs()[0], 2.0, {}).arc_m, 2.3, 1e-9);
  EXPECT_NEAR(legs.project({-0.3, 0}, legs.legs()[0], 0.0, {}).arc_m, -0.3, 1e-9);
}

TEST(TrajectoryLegs, StaysOnItsOwnBranchAtACrossing) {
  const TrajectoryLegs legs(testing::figure_of_eight({}));
  const Leg& leg = legs.legs()[0];
  // The start is passed again half-way, at the crossing.
  EXPECT_NEAR(legs.project({0.0, 0.0}, leg, 0.1, {}).arc_m, 0.0, 0.02);
  EXPECT_GT(legs.project({0.0, 0.0}, leg, 3.5, {}).arc_m, 3.0);
}

TEST(TrajectoryLegs, RefusesWhatCannotBeDriven) {
  EXPECT_THROW(TrajectoryLegs({}), maps::InputError);
  planning::Trajectory t;
  t.points = {at_time(1), at_time(0)};
  EXPECT_THROW(TrajectoryLegs{t}, maps::InputError);
  t.points = {at_time(0), at_time(1)};
  t.points[1].pose.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(TrajectoryLegs{t}, maps::InputError);
}

TEST(Approach, TurnsDrivesAndTurnsFromRestToRest) {
  const DriveLimits limits;
  const auto way = approach_trajectory({0, 0, 0}, {0.1, 0.1, 0}, 0.15, 0.01, limits);
  const TrajectoryLegs legs(way);
  ASSERT_EQ(legs.legs().size(), 3u);
  EXPECT_NEAR(way.points.back().pose.x, 0.1, 1e-9);
  EXPECT_NEAR(way.points.back().pose.y, 0.1, 1e-9);
  EXPECT_NEAR(way.points.back().pose.phi, 0.0, 1e-9);
  for (std::size_t i = 1; i < way.points.size(); ++i) {
    const auto &a = way.points[i - 1], &b = way.points[i];
    const double dt = b.time_s - a.time_s;
    ASSERT_GT(dt, 0.0);
    ASSERT_LE(dt, 0.05);
    const double moved = maps::distance(maps::position_of(a.pose), maps::position_of(b.pose));
    EXPECT_NEAR(moved / dt, (a.speed_m_s + b.speed_m_s) / 2, 5e-3);
    EXPECT_LE(b.speed_m_s, 0.15 + 1e-12);
  }
}

TEST(Approach, OnlyTurnsWhenThePlaceIsRight) {
  const auto way = approach_trajectory({0, 0, 0}, {0.001, 0, 1.0}, 0.15, 0.01, {});
  const TrajectoryLegs legs(way);
  ASSERT_EQ(legs.legs().size(), 1u);
  EXPECT_EQ(legs.legs()[0].kind, LegKind::kTurn);
}

}  // namespace
}  // namespace rovigo::control
