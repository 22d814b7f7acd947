// The tracker on a plant with known faults: random trajectories, random speeds, hostile poses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "control/command_limiter.h"
#include "control/path_follower.h"
#include "control/tracking_metrics.h"
#include "tests/unit/control/plant.h"

namespace rovigo::control {
namespace {

using testing::DriveSetup;
using testing::Plant;
using testing::PlantOptions;
using testing::TrajectoryBuilder;

constexpr unsigned kSeed = 20262;

maps::RobotModel robot_of(double speed) {
  maps::RobotModel robot;
  robot.max_speed_m_s = speed;
  return robot;
}

/// A sum of three waves of curvature, at most 1.6 1/m, from rest to rest.
planning::Trajectory random_smooth(const maps::RobotModel& robot, double length,
                                   std::mt19937_64& random) {
  std::uniform_real_distribution<double> size(0.2, 0.53), wave(1.2, 4.0), phase(-3.0, 3.0);
  double a[3], w[3], p[3];
  for (int i = 0; i < 3; ++i) {
    a[i] = size(random);
    w[i] = 2 * maps::kPi / wave(random);
    p[i] = phase(random);
  }
  return TrajectoryBuilder(robot, {phase(random), phase(random), phase(random)})
      .drive(length,
             [=](double s) {
               double bend = 0.0;
               for (int i = 0; i < 3; ++i) bend += a[i] * std::sin(w[i] * s + p[i]);
               return bend;
             })
      .get();
}

DriveMetrics track(const planning::Trajectory& plan, const maps::RobotModel& robot,
                   const PlantOptions& plant_options, const DriveSetup& setup) {
  Plant plant(plant_options, plan.points.front().pose);
  TrajectoryTracker tracker({}, robot, plan);
  const DriveLog log = run_drive(tracker, plant, setup);
  EXPECT_EQ(log.status, TrackStatus::kReached);
  return measure(log, plan, plan.points.back().pose, true);
}

class TrackerAtSpeed : public ::testing::TestWithParam<double> {};

TEST_P(TrackerAtSpeed, RandomSmoothTrajectoriesOnTheNominalPlant) {
  const maps::RobotModel robot = robot_of(GetParam());
  std::mt19937_64 random(kSeed);
  for (int run = 0; run < 8; ++run) {
    const auto plan = random_smooth(robot, GetParam() < 0.15 ? 1.5 : 4.0, random);
    const DriveMetrics m = track(plan, robot, {}, {});
    EXPECT_LE(m.cross_track_rms_m, 0.002) << "seed " << kSeed << " run " << run;
    EXPECT_LE(m.cross_track_max_m, 0.005) << "seed " << kSeed << " run " << run;
    EXPECT_LE(m.final_position_error_m, 0.006) << "seed " << kSeed << " run " << run;
    EXPECT_LE(m.final_heading_error_rad, 0.01) << "seed " << kSeed << " run " << run;
    EXPECT_LE(m.duration_s, 1.05 * m.planned_duration_s + 2.0) << "seed " << kSeed;
  }
}

TEST_P(TrackerAtSpeed, ScrubbingSlipNoiseAndLatencyTogether) {
  const maps::RobotModel robot = robot_of(GetParam());
  const PlantOptions worn{.lag_s = 0.1, .speed_gain = 0.97, .yaw_gain = 0.87, .yaw_bias_1_m = 0.03};
  const DriveSetup poor{
      .pose_latency_s = 0.1, .position_noise_m = 0.005, .yaw_noise_rad = 0.005, .sigma_m = 0.005};
  std::mt19937_64 random(kSeed);
  for (int run = 0; run < 4; ++run) {
    const auto plan = random_smooth(robot, GetParam() < 0.15 ? 1.5 : 4.0, random);
    const DriveMetrics m = track(plan, robot, worn, poor);
    EXPECT_LE(m.cross_track_rms_m, 0.010) << "seed " << kSeed << " run " << run;
    EXPECT_LE(m.final_position_error_m, 0.020) << "seed " << kSeed << " run " << run;
  }
}

TEST_P(TrackerAtSpeed, TurnsUpToHalfATurnBetweenStraights) {
  const maps::RobotModel robot = robot_of(GetParam());
  for (const double angle : {maps::kPi / 2, -2.36, maps::kPi, -maps::kPi}) {
    const auto plan = TrajectoryBuilder(robot, {}).line(0.6).turn(angle).line(0.6).get();
    for (const double gain : {1.0, 0.88}) {
      const DriveMetrics m = track(plan, robot, {.yaw_gain = gain}, {});
      EXPECT_LE(m.cross_track_max_m, 0.005) << angle << " gain " << gain;
      EXPECT_LE(m.final_heading_error_rad, 0.015) << angle << " gain " << gain;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, TrackerAtSpeed, ::testing::Values(0.05, 0.1, 0.25, 0.4, 0.8),
                         [](const auto& speed) {
                           return "cm_s_" +
                                  std::to_string(static_cast<int>(speed.param * 100 + .5));
                         });

double hostile(std::mt19937_64& random, double sane) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  switch (random() % 16) {
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    case 1:
      return random() % 2 ? kInf : -kInf;
    case 2:
      return 1e300;
    case 3:
      return std::uniform_real_distribution<double>(-50.0, 50.0)(random);
    default:
      return sane;
  }
}

TEST(TrackerProperty, CommandsStayWithinTheLimitsWhateverThePosesSay) {
  std::mt19937_64 random(kSeed);
  for (int run = 0; run < 40; ++run) {
    const maps::RobotModel robot = robot_of(0.8);
    const DriveLimits limits = drive_limits({}, robot);
    const auto plan = random_smooth(robot, 3.0, random);
    TrajectoryTracker tracker({}, robot, plan);
    TTwist2D last;
    double now = 0.0;
    for (int i = 0; i < 1500; ++i) {
      const auto truth = planning::sample(plan, now);
      PoseInput pose;
      pose.time_s = hostile(random, now - 0.03);
      pose.map_from_base = {hostile(random, truth.pose.x), hostile(random, truth.pose.y),
                            hostile(random, truth.pose.phi)};
      pose.sigma_position_m = hostile(random, 0.01);
      pose.quality = static_cast<PoseQuality>(random() % 8 < 6 ? 0 : random() % 3);
      const double dt = random() % 20 == 0 ? 0.0 : 0.01;
      now += dt;
      const TrackerOutput out = tracker.step(now, pose);
      const TTwist2D c = out.command;
      const std::string where = "seed " + std::to_string(kSeed) + " run " + std::to_string(run) +
                                " step " + std::to_string(i);
      ASSERT_GE(c.vx, -kTurnBackSpeedMS) << where;  // backwards in turns only
      ASSERT_LE(c.vx, limits.max_speed_m_s) << where;
      ASSERT_EQ(c.vy, 0.0) << where;
      ASSERT_LE(std::abs(c.omega), limits.max_yaw_rate_rad_s) << where;
      ASSERT_LE(std::abs(c.vx) + std::abs(c.omega) * limits.track_width_m / 2,
                limits.max_wheel_speed_m_s + 1e-12)
          << where;
      const bool stopped = c.vx == 0.0 && c.omega == 0.0;
      if (!stopped) {
        ASSERT_LE(std::abs(c.vx - last.vx), limits.max_acceleration_m_s2 * dt + 1e-12) << where;
        ASSERT_LE(std::abs(c.omega - last.omega), limits.max_yaw_acceleration_rad_s2 * dt + 1e-12)
            << where;
      }
      last = c;
    }
  }
}

TEST(TrackerProperty, StopsWithinAFifthOfASecondOfTheLastPoseWheneverThatIs) {
  std::mt19937_64 random(kSeed);
  const maps::RobotModel robot = robot_of(0.8);
  for (int run = 0; run < 40; ++run) {
    const auto plan = random_smooth(robot, 3.0, random);
    std::uniform_real_distribution<double> when(0.3, plan.duration_s() - 0.3);
    const double lost_at = when(random);
    DriveSetup setup{.step_s = 1.0 / 240, .pose_latency_s = 0.03};
    setup.tamper = [lost_at](double t, PoseInput& pose) {
      if (t >= lost_at) pose.time_s = -1.0;
    };
    Plant plant({}, plan.points.front().pose);
    TrajectoryTracker tracker({}, robot, plan);
    const DriveLog log = run_drive(tracker, plant, setup);
    for (const DriveStep& s : log.steps) {
      if (s.time_s < lost_at + 0.2) continue;
      ASSERT_EQ(s.command.vx, 0.0) << "seed " << kSeed << " run " << run << " at " << s.time_s;
      ASSERT_EQ(s.command.omega, 0.0) << "seed " << kSeed << " run " << run;
    }
    EXPECT_EQ(log.status, TrackStatus::kPoseLost);
  }
}

TEST(TrackerProperty, StepRateDoesNotMatter) {
  std::mt19937_64 random(kSeed);
  const auto plan = random_smooth({}, 3.0, random);
  for (const double rate : {20.0, 50.0, 100.0, 240.0, 500.0}) {
    const DriveMetrics m = track(plan, {}, {}, {.step_s = 1.0 / rate});
    EXPECT_LE(m.cross_track_rms_m, 0.005) << rate;
    EXPECT_LE(m.final_position_error_m, 0.01) << rate;
  }
}

}  // namespace
}  // namespace rovigo::control
