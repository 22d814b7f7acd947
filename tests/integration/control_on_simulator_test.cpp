// The tracker against the real physics: motors, stiction, scrubbing wheels, slip.
#include <gtest/gtest.h>

#include <cmath>

#include "control/path_follower.h"
#include "control/tracking_metrics.h"
#include "tests/unit/control/mission_check.h"
#include "tests/unit/control/plant.h"
#include "tests/unit/control/simulated_drive.h"

namespace rovigo::control {
namespace {

using testing::drive_in_hall;
using testing::expect_mission_done;
using testing::SimulatedDrive;
using testing::TrajectoryBuilder;

struct Limits {
  double cross_track_rms_m = 0.005;
  double cross_track_max_m = 0.015;
  double final_position_m = 0.01;
  double final_heading_rad = 0.02;
};

void expect_tracked(const planning::Trajectory& plan, const SimulatedDrive& setup,
                    const Limits& limits, const std::string& name) {
  const DriveLog log = drive_in_hall(plan, setup);
  const DriveMetrics m = measure(log, plan, plan.points.back().pose, true);
  EXPECT_EQ(log.status, TrackStatus::kReached) << name;
  EXPECT_EQ(log.contact_events, 0) << name;
  EXPECT_LE(m.cross_track_rms_m, limits.cross_track_rms_m) << name;
  EXPECT_LE(m.cross_track_max_m, limits.cross_track_max_m) << name;
  EXPECT_LE(m.final_position_error_m, limits.final_position_m) << name;
  EXPECT_LE(m.final_heading_error_rad, limits.final_heading_rad) << name;
  for (const DriveStep& s : log.steps) ASSERT_GE(s.command.vx, -kTurnBackSpeedMS) << name;
}

planning::Trajectory with_large_turns(const maps::RobotModel& robot) {
  return TrajectoryBuilder(robot, {})
      .line(1)
      .turn(maps::kPi)
      .line(1)
      .turn(-2.36)
      .line(1)
      .turn(maps::kPi / 2)
      .get();
}

void expect_all_tracked(const SimulatedDrive& setup, const Limits& limits) {
  expect_tracked(testing::moderate_curve(setup.robot), setup, limits, "curve");
  expect_tracked(testing::figure_of_eight(setup.robot), setup, limits, "figure of eight");
  expect_tracked(testing::square(setup.robot), setup, limits, "square");
  expect_tracked(testing::slalom(setup.robot), setup, limits, "slalom");
  expect_tracked(with_large_turns(setup.robot), setup, limits, "large turns");
}

TEST(ControlOnSimulator, TracksOnTruePosesWithoutDisturbance) { expect_all_tracked({}, {}); }

TEST(ControlOnSimulator, SameSettingsServeSlowAndFast) {
  for (const double speed : {0.1, 0.8}) {
    SimulatedDrive setup;
    setup.robot.max_speed_m_s = speed;
    expect_tracked(testing::moderate_curve(setup.robot), setup, {}, std::to_string(speed));
    expect_tracked(with_large_turns(setup.robot), setup, {}, std::to_string(speed));
  }
}

TEST(ControlOnSimulator, TracksWithSlipOnPoorAndLatePoses) {
  SimulatedDrive setup;
  setup.scenario = sim::Scenario();  // the default one: slip events, worn encoders
  setup.poses = {
      .latency_s = 0.1, .jitter_s = 0.02, .position_noise_m = 0.01, .heading_noise_rad = 0.01};
  for (const std::uint64_t seed : {1, 2, 3}) {
    setup.seed = seed;
    expect_all_tracked(setup, {.cross_track_rms_m = 0.02,
                               .cross_track_max_m = 0.06,
                               .final_position_m = 0.03,
                               .final_heading_rad = 0.05});
  }
}

TEST(ControlOnSimulator, WheelsThatStickBelowATenthOfAMetrePerSecondDoNotStopIt) {
  SimulatedDrive setup;
  setup.scenario = sim::Scenario();
  setup.scenario.motor.dead_zone_m_s = 0.1;  // twice what the controller takes it for
  setup.poses = {.latency_s = 0.05, .position_noise_m = 0.01, .heading_noise_rad = 0.01};
  for (const std::uint64_t seed : {1, 2}) {
    setup.seed = seed;
    expect_all_tracked(setup, {.cross_track_rms_m = 0.02,
                               .cross_track_max_m = 0.06,
                               .final_position_m = 0.03,
                               .final_heading_rad = 0.06});
  }
}

TEST(ControlOnSimulator, OnWetPatchesItTurnsInPlaceWithoutSlidingFar) {
  SimulatedDrive setup;
  setup.scenario = sim::Scenario();
  setup.scenario.grip.slippery_share = 0.25;
  setup.poses = {.latency_s = 0.05, .position_noise_m = 0.01, .heading_noise_rad = 0.01};
  const auto plan = TrajectoryBuilder(setup.robot, {}).line(1).turn(maps::kPi).line(1).get();
  for (const std::uint64_t seed : {2, 11, 13, 15, 19}) {
    setup.seed = seed;
    expect_tracked(plan, setup,
                   {.cross_track_rms_m = 0.02,
                    .cross_track_max_m = 0.06,
                    .final_position_m = 0.03,
                    .final_heading_rad = 0.05},
                   "seed " + std::to_string(seed));
  }
}

TEST(ControlOnSimulator, RandomMissionsOnPoorPosesAllArrive) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) expect_mission_done(seed);
}

TEST(ControlOnSimulator, SameSeedSameBytes) {
  SimulatedDrive setup;
  setup.scenario = sim::Scenario();
  setup.poses.position_noise_m = 0.01;
  const auto plan = testing::moderate_curve(setup.robot);
  const DriveLog a = drive_in_hall(plan, setup), b = drive_in_hall(plan, setup);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    ASSERT_EQ(a.steps[i].true_pose.x, b.steps[i].true_pose.x) << i;
    ASSERT_EQ(a.steps[i].command.omega, b.steps[i].command.omega) << i;
  }
}

}  // namespace
}  // namespace rovigo::control
