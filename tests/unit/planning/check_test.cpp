#include "planning/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A sound straight drive through the middle of a 4 x 2 m room.
Trajectory sound_drive(double y = 1.0) {
  TimingProblem problem;
  problem.pieces = {{.curve = CubicBSpline::uniform({{0.5, y}, {3.5, y}})}};
  return time_path(problem, {}, {});
}

TrajectoryReport judged(const Trajectory& trajectory, CheckOptions options = {}) {
  return check(trajectory, room(4.0, 2.0), options);
}

TEST(Check, FindsNothingWrongWithASoundDrive) {
  const auto report = judged(sound_drive());
  EXPECT_THAT(report.problems, IsEmpty());
  EXPECT_NEAR(report.min_clearance_m, 0.45, 1e-6);  // from the wall at x = 0.05
  EXPECT_GT(report.samples, 1500U);
}

TEST(Check, SeesAnObstacleBetweenTwoPoints) {
  Trajectory sparse;
  sparse.points = {{.time_s = 0.0, .pose = {0.5, 1.0, 0.0}},
                   {.time_s = 10.0, .pose = {3.5, 1.0, 0.0}}};
  auto grid = room(4.0, 2.0);
  fill(grid, 2.0, 0.9, 2.05, 1.1);
  EXPECT_GT(check(sparse, grid, {}).unsafe_samples, 0U);
}

TEST(Check, SeesAPathTooNearToAWall) {
  EXPECT_THAT(judged(sound_drive(0.35)).problems, IsEmpty());
  const auto report = judged(sound_drive(0.34));
  EXPECT_THAT(report.problems, Contains(HasSubstr("unsafe")));
  EXPECT_NEAR(report.min_clearance_m, 0.29, 1e-6);
}

TEST(Check, UnknownGroundIsUnsafeInMapModeZeroOnly) {
  auto grid = room(4.0, 2.0);
  grid.at({40, 20}) = maps::OccupancyGrid::kUnknown;
  EXPECT_GT(check(sound_drive(1.01), grid, {}).unsafe_samples, 0U);
  EXPECT_EQ(check(sound_drive(1.01), grid, {.unknown_is_blocked = false}).unsafe_samples, 0U);
}

TEST(Check, SeesBrokenLimits) {
  auto fast = sound_drive();
  for (auto& p : fast.points) p.time_s *= 0.5;
  EXPECT_THAT(judged(fast).problems, Contains(HasSubstr("slip")));
  EXPECT_THAT(judged(fast).problems, Contains(HasSubstr("acceleration")));
  EXPECT_THAT(judged(sound_drive(), {.limits = {.speed_m_s = 0.3}}).problems,
              Contains(HasSubstr("speed")));
}

TEST(Check, SeesAJump) {
  auto jump = sound_drive();
  for (std::size_t i = jump.points.size() / 2; i < jump.points.size(); ++i) {
    jump.points[i].pose.x += 0.1;
  }
  EXPECT_THAT(judged(jump).problems, Contains(HasSubstr("slip")));
}

TEST(Check, SeesSidewaysMotion) {
  auto crab = sound_drive();
  for (auto& p : crab.points) p.pose.phi = 0.3;
  EXPECT_THAT(judged(crab).problems, Contains(HasSubstr("side slip")));
}

TEST(Check, SeesAStartInMotionAndTimeThatStandsStill) {
  auto moving = sound_drive();
  moving.points.erase(moving.points.begin(), moving.points.begin() + 20);
  EXPECT_THAT(judged(moving).problems, Contains(HasSubstr("not at rest")));
  auto frozen = sound_drive();
  frozen.points[5].time_s = frozen.points[4].time_s;
  EXPECT_THAT(judged(frozen).problems, Contains(HasSubstr("time does not increase")));
  auto broken = sound_drive();
  broken.points[5].pose.x = std::nan("");
  EXPECT_THAT(judged(broken).problems, Contains(HasSubstr("not finite")));
  EXPECT_THAT(judged({}).problems, Contains(HasSubstr("no points")));
}

TEST(Check, AnEscapeMayBeginNearAnObstacleButNotComeNearer) {
  TimingProblem problem;
  problem.pieces = {{.curve = CubicBSpline::uniform({{0.25, 1.0}, {1.0, 1.0}}), .slow = true}};
  const auto away = time_path(problem, {}, {});
  EXPECT_GT(judged(away).unsafe_samples, 0U);
  EXPECT_EQ(judged(away, {.escape_allowed = true}).unsafe_samples, 0U);
  problem.pieces = {{.curve = CubicBSpline::uniform({{0.25, 1.0}, {0.10, 1.0}}), .slow = true}};
  EXPECT_GT(judged(time_path(problem, {}, {}), {.escape_allowed = true}).unsafe_samples, 0U);
}

}  // namespace
}  // namespace rovigo::planning
