// Random curves driven as fast as the limits allow, and new ways spliced into running trajectories.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/check.h"
#include "planning/smoother.h"
#include "planning/splice.h"
#include "planning/timing.h"

namespace rovigo::planning {
namespace {

/// 40 x 40 m of free ground.
struct OpenGround {
  maps::OccupancyGrid grid;
  maps::Costmap costmap;
  FreeSpace space;
  static maps::GridGeometry geometry() {
    maps::GridGeometry g;
    g.resolution_m = 0.5;
    g.width = g.height = 80;
    return g;
  }
  OpenGround()
      : grid(geometry(), maps::OccupancyGrid::kFree),
        costmap(geometry()),
        space(grid, costmap, 0.3) {}
};

class RandomCurves {
 public:
  explicit RandomCurves(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Path zigzag(const TPoint2D& from, double heading, int legs) {
    Path path{{from}};
    for (int i = 0; i < legs; ++i) {
      heading += i == 0 ? between(-0.5, 0.5) : between(-1.4, 1.4);
      const double length = between(0.5, 2.0);
      const TPoint2D& last = path.points.back();
      path.points.push_back(
          {last.x + length * std::cos(heading), last.y + length * std::sin(heading)});
    }
    return path;
  }
  MotionLimits limits() {
    return {.speed_m_s = between(0.1, 0.8),
            .yaw_rate_rad_s = between(0.3, 2.0),
            .acceleration_m_s2 = between(0.1, 1.0),
            .yaw_acceleration_rad_s2 = between(0.5, 4.0),
            .lateral_acceleration_m_s2 = between(0.1, 1.0),
            .wheel_speed_m_s = between(0.2, 1.0),
            .track_width_m = 0.358};
  }

 private:
  std::mt19937_64 random_;
};

TEST(RandomTrajectories, NeverExceedTheirLimits) {
  constexpr std::uint64_t kSeed = 17;
  RandomCurves random(kSeed);
  const OpenGround ground;
  for (int i = 0; i < 60; ++i) {
    const MotionLimits limits = random.limits();
    SmoothingProblem problem;
    problem.polyline = random.zigzag({20, 20}, random.between(-3, 3), 6);
    TimingProblem timed;
    timed.pieces = smooth(ground.space, problem, {});
    timed.goal_heading_rad = random.between(-3, 3);
    const Trajectory trajectory = time_path(timed, limits, {});
    const auto report = check(trajectory, ground.grid, {.limits = limits});
    ASSERT_THAT(report.problems, testing::IsEmpty()) << "seed " << kSeed << " curve " << i;
  }
}

/// Time from rest to rest over a length with one speed and one acceleration.
double trapezoid_s(double length, double speed, double acceleration) {
  if (length < speed * speed / acceleration) return 2.0 * std::sqrt(length / acceleration);
  return length / speed + speed / acceleration;
}

TEST(RandomTrajectories, LinesAndArcsTakeTheBestTimeThereIs) {
  RandomCurves random(18);
  for (int i = 0; i < 40; ++i) {
    const MotionLimits limits = random.limits();
    const double length = random.between(0.2, 6.0);
    TimingProblem line;
    line.pieces = {{.curve = CubicBSpline::uniform({{0, 0}, {length, 0}})}};
    const double v = std::min(limits.speed_m_s, limits.wheel_speed_m_s);
    const double shortest = trapezoid_s(length, v, limits.acceleration_m_s2);
    EXPECT_NEAR(time_path(line, limits, {}).duration_s(), shortest, 2e-3 * shortest);

    // An arc: its curvature grows over the first and last 5 cm only.
    const double radius = random.between(0.5, 3.0);
    const double angle = random.between(2.0, 5.0);
    std::vector<TPoint2D> points;
    const int n = static_cast<int>(angle * radius / 0.05);
    for (int k = 0; k <= n; ++k) {
      const double a = angle * k / n;
      points.push_back({radius * std::sin(a), radius * (1.0 - std::cos(a))});
    }
    TimingProblem arc;
    arc.pieces = {{.curve = CubicBSpline::uniform(points)}};
    const double bend = 1.0 / radius;
    const double fastest = std::min(
        {limits.speed_m_s, limits.wheel_speed_m_s / (1.0 + 0.5 * bend * limits.track_width_m),
         limits.yaw_rate_rad_s / bend, std::sqrt(limits.lateral_acceleration_m_s2 / bend)});
    const double a = std::min(limits.acceleration_m_s2, limits.yaw_acceleration_rad_s2 / bend);
    const double best = trapezoid_s(angle * radius, fastest, a);
    const double ours = time_path(arc, limits, {}).duration_s();
    EXPECT_GT(ours, 0.99 * best);
    EXPECT_LT(ours, 1.04 * best) << "curve " << i;
  }
}

TEST(RandomTrajectories, AreSlowNearObstaclesWhereAsked) {
  const MotionLimits limits;
  TimingProblem line;
  line.pieces = {{.curve = CubicBSpline::uniform({{0, 0}, {6, 0}})}};
  line.room_m = [](const TPoint2D& p) { return std::abs(p.x - 3.0); };
  TimingConfig config;
  const double unhindered = time_path(line, limits, config).duration_s();
  config.slow_within_m = 0.5;
  config.slow_speed_m_s = 0.1;
  const Trajectory slowed = time_path(line, limits, config);
  EXPECT_GT(slowed.duration_s(), unhindered + 1.0);
  for (const auto& p : slowed.points) {
    const double share = std::min(1.0, std::abs(p.pose.x - 3.0) / 0.5);
    EXPECT_LE(p.speed_m_s, 0.1 + share * 0.3 + 0.01);
  }
}

TEST(Splice, StartsInTheRunningStateAndKeepsTheLimits) {
  constexpr std::uint64_t kSeed = 19;
  RandomCurves random(kSeed);
  const OpenGround ground;
  const TimingConfig config;
  const MotionLimits limits;
  int spliced = 0;
  int too_fast = 0;
  int no_room = 0;
  for (int i = 0; i < 60; ++i) {
    SmoothingProblem problem;
    problem.polyline = random.zigzag({20, 20}, random.between(-3, 3), 5);
    TimingProblem timed;
    timed.pieces = smooth(ground.space, problem, {});
    const Trajectory running = time_path(timed, limits, config);
    const double when = random.between(0.0, running.duration_s());
    const TrajectoryPoint at = sample(running, when);
    const Path way = random.zigzag(maps::position_of(at.pose), at.pose.phi, 4);
    const SpliceResult result = splice(
        ground.space, {.running = running, .time_s = when, .way = way, .goal_heading_rad = {}}, {},
        limits, config);
    if (result.status != SpliceStatus::kOk) {
      EXPECT_TRUE(result.trajectory.points.empty());
      ++(result.status == SpliceStatus::kTooFast ? too_fast : no_room);
      continue;
    }
    ++spliced;
    const TrajectoryPoint& first = result.trajectory.points.front();
    ASSERT_NEAR(maps::distance(maps::position_of(first.pose), maps::position_of(at.pose)), 0.0,
                1e-9);
    ASSERT_NEAR(maps::wrap_angle(first.pose.phi - at.pose.phi), 0.0, 1e-9);
    ASSERT_NEAR(first.speed_m_s, at.speed_m_s, 1e-9);
    ASSERT_NEAR(first.yaw_rate_rad_s, at.yaw_rate_rad_s, 1e-9);
    const TPose2D& end = result.trajectory.points.back().pose;
    ASSERT_NEAR(maps::distance(maps::position_of(end), way.points.back()), 0.0, 1e-6);
    // The checker sees jumps of speed and turn rate as accelerations.
    const Trajectory whole = joined(running, when, result.trajectory);
    const auto report = check(whole, ground.grid, {.limits = limits});
    ASSERT_THAT(report.problems, testing::IsEmpty()) << "seed " << kSeed << " splice " << i;
  }
  EXPECT_GT(spliced, 45) << too_fast << " too fast, " << no_room << " without room";
}

TEST(Splice, ATurnInPlaceIsFinishedOrTurnedBack) {
  const OpenGround ground;
  const MotionLimits limits;
  TimingProblem turning;
  turning.at = {20, 20};
  turning.start_heading_rad = 0.0;
  turning.goal_heading_rad = 2.5;
  const Trajectory running = time_path(turning, limits, {});
  for (const double heading : {-1.0, 0.1, 1.0, 2.0, 3.0}) {
    const Path way{{{20, 20}, {20 + 2 * std::cos(heading), 20 + 2 * std::sin(heading)}}};
    const SpliceResult result = splice(
        ground.space, {.running = running, .time_s = 0.9, .way = way, .goal_heading_rad = {}}, {},
        limits, {});
    ASSERT_EQ(result.status, SpliceStatus::kOk);
    const auto report =
        check(joined(running, 0.9, result.trajectory), ground.grid, {.limits = limits});
    EXPECT_THAT(report.problems, testing::IsEmpty()) << heading;
  }
}

TEST(Splice, RefusesAWayBackThatASpeedingRoverCannotTake) {
  const OpenGround ground;
  const MotionLimits limits;
  TimingProblem straight;
  straight.pieces = {{.curve = CubicBSpline::uniform({{10, 20}, {15, 20}})}};
  const Trajectory running = time_path(straight, limits, {});
  const double when = 0.5 * running.duration_s();
  const Path way{{{12.5, 20}, {12.0, 20.0}}};
  MotionLimits weak = limits;
  weak.acceleration_m_s2 = 0.05;  // 0.4 m/s take 1.6 m to brake
  const SpliceResult result =
      splice(ground.space, {.running = running, .time_s = when, .way = way, .goal_heading_rad = {}},
             {}, weak, {});
  EXPECT_NE(result.status, SpliceStatus::kOk);
  EXPECT_TRUE(result.trajectory.points.empty());
}

}  // namespace
}  // namespace rovigo::planning
