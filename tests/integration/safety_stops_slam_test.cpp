// The safety stops where poses come from SLAM's localiser on a rendered camera: a stretch of the
// lab is mapped, then driven in that map while sensors, poses and commands break.

#include <gtest/gtest.h>

#include <cmath>

#include "app/ground.h"
#include "app/resources.h"
#include "app/simulated_drive.h"
#include "control/tracker.h"
#include "slam/slam.h"
#include "tests/unit/control/plant.h"

namespace rovigo::app {
namespace {

constexpr double kCameraHz = 4.0;  // enough at this speed, and quick
constexpr double kStandingMS = 0.005, kStandingRadS = 0.02;
const TPose2D kWorldFromMap{1.2, 5.55, 0.0};  // the lab's corridor

planning::Trajectory course() {
  return control::testing::TrajectoryBuilder(maps::RobotModel{}, {})
      .drive(3.8, [](double s) { return 0.15 * std::sin(2.0 * s); })
      .get();
}

struct Lab {
  sim::World world = open_world("lab");
  RovigoConfig config;
  planning::Trajectory plan = course();

  sim::SimulatorOptions put_down(const sim::Scenario& scenario, std::uint64_t seed) const {
    sim::SimulatorOptions options;
    options.robot = config.robot;
    options.scenario = scenario;
    options.world_from_base = kWorldFromMap;
    options.seed = seed;
    options.camera_rate_hz = kCameraHz;
    return options;
  }

  control::DriveLog drive(sim::Simulator& simulator, PoseSource& poses,
                          const DriveHooks& hooks) const {
    control::TrajectoryTracker tracker(config.control, config.robot, plan);
    return drive_in_simulator(simulator, kWorldFromMap, poses, tracker, plan.duration_s(), config,
                              hooks);
  }
};

/// Driven once on true poses, and mapped.
maps::SavedMap map_of(const Lab& lab) {
  sim::Simulator simulator(lab.world, lab.put_down({}, 11));
  slam::Rig rig;
  rig.camera = simulator.rig().camera;
  rig.base_from_camera = simulator.rig().base_from_camera;
  rig.has_extrinsics = rig.has_wheels = rig.has_imu = true;
  slam::Slam slam(lab.config.slam, rig);
  DriveHooks hooks;
  hooks.observation = [&](const mrpt::obs::CObservation& o) { slam.process(o); };
  const auto poses = true_poses(simulator, kWorldFromMap);
  lab.drive(simulator, *poses, hooks);
  return slam.finish();
}

control::DriveLog drive_with(const sim::Scenario& scenario,
                             const control::ControlConfig& control = {}) {
  static Lab lab;
  static const maps::SavedMap map = map_of(lab);
  lab.config.control = control;
  sim::Simulator simulator(lab.world, lab.put_down(scenario, 12));
  const auto poses = open_poses({.kind = "slam", .map_name = "lab", .start = {}}, lab.config, map,
                                kWorldFromMap, simulator, scenario);
  return lab.drive(simulator, *poses, {});
}

bool is_zero(const TTwist2D& c) { return c.vx == 0.0 && c.omega == 0.0; }
bool stands(const TTwist2D& t) {
  return std::abs(t.vx) < kStandingMS && std::abs(t.omega) < kStandingRadS;
}

struct Case {
  sim::Fault fault;
  control::StopCause cause;
};

/// One after the other in one drive. What is late is so for long enough that old news arrive.
std::vector<Case> one_after_the_other() {
  using control::StopCause;
  std::vector<Case> cases{{{.kind = "sensors_stall"}, StopCause::kNoPoses},
                          {{.kind = "battery_low"}, StopCause::kLowBattery},
                          {{.kind = "sensors_late"}, StopCause::kOldPoses},
                          {{.kind = "manual_takeover"}, StopCause::kManual},
                          {{.kind = "poses_late"}, StopCause::kOldPoses},
                          {{.kind = "poses_stall"}, StopCause::kNoPoses},
                          {{.kind = "set_points_stop"}, StopCause::kNoSetPoints},
                          {{.kind = "poses_not_finite"}, StopCause::kBadPoses}};
  double start_s = kStandBeforeS + 2.0;
  for (Case& c : cases) {
    const bool late = c.fault.kind.ends_with("_late");
    c.fault.start_s = start_s;
    c.fault.duration_s = late ? 2.6 : 1.2;
    start_s += c.fault.duration_s + 1.3;
  }
  return cases;
}

TEST(SafetyStopsOnSlamPoses, EveryFaultStopsTheRoverInTimeAndTheDriveGoesOnToItsGoal) {
  const std::vector<Case> cases = one_after_the_other();
  sim::Scenario scenario;
  for (const Case& c : cases) scenario.faults.push_back(c.fault);
  const control::DriveLog log = drive_with(scenario);
  EXPECT_EQ(log.status, control::TrackStatus::kReached);
  EXPECT_EQ(log.contact_events, 0);
  for (const Case& c : cases) {
    const double begin_s = c.fault.start_s - kStandBeforeS;
    const double zero_by_s = begin_s + control::ControlConfig{}.watchdog_s + 1e-9;
    double speed_m_s = 0.0;  // when the fault began
    double still_by_s = 0.0;
    bool named = false;
    for (const control::DriveStep& s : log.steps) {
      if (s.time_s <= begin_s) {
        speed_m_s = s.true_twist.vx;
        still_by_s = zero_by_s + speed_m_s / maps::RobotModel{}.max_acceleration_m_s2;
      }
      if (s.time_s <= zero_by_s || s.time_s >= begin_s + c.fault.duration_s) continue;
      named |= s.held == c.cause;
      ASSERT_TRUE(is_zero(s.command)) << c.fault.kind << " at " << s.time_s;
      if (s.time_s > still_by_s) {
        ASSERT_TRUE(stands(s.true_twist)) << c.fault.kind << " at " << s.time_s;
      }
    }
    EXPECT_GT(speed_m_s, 0.2) << c.fault.kind << ": it did not drive when the fault began";
    EXPECT_TRUE(named) << c.fault.kind;
  }
}

sim::Scenario camera_silent(double begin_s) {
  sim::Scenario scenario;
  scenario.blackouts = {{.start_s = begin_s + kStandBeforeS, .duration_s = 100.0}};
  return scenario;
}

sim::Scenario camera_late(double begin_s) {
  sim::Scenario scenario;
  scenario.faults = {{.kind = "camera_late", .start_s = begin_s + kStandBeforeS}};
  return scenario;
}

/// By wheels and gyro the rover knows for a while where it is.
TEST(SafetyStopsOnSlamPoses, WithoutFramesItGoesSlowlyAndStopsOnceItsPoseIsTooDoubtful) {
  constexpr double kBeginS = 2.0, kToBelieveS = 2.0;
  control::ControlConfig strict;
  strict.max_doubtful_sigma_m = 0.02;  // the test need not wait for the default's 0.1 m
  strict.pose_patience_s = 1.0;
  for (const sim::Scenario& scenario : {camera_silent(kBeginS), camera_late(kBeginS)}) {
    const control::DriveLog log = drive_with(scenario, strict);
    double usable_s = 0.0;  // the last pose that may be driven on
    for (const control::DriveStep& s : log.steps) {
      if (s.quality == control::PoseQuality::kGood ||
          (s.quality == control::PoseQuality::kDoubtful &&
           s.sigma_position_m <= strict.max_doubtful_sigma_m)) {
        usable_s = s.time_s;
      }
      if (s.time_s < kBeginS + kToBelieveS) continue;
      ASSERT_NE(s.quality, control::PoseQuality::kGood) << s.time_s;
      ASSERT_LE(s.command.vx, strict.doubtful_speed_m_s + 1e-9) << s.time_s;
      if (s.time_s > usable_s + strict.watchdog_s + 1e-9) {
        ASSERT_TRUE(is_zero(s.command)) << s.time_s;
      }
    }
    EXPECT_EQ(log.held, control::StopCause::kLostPoses);
    EXPECT_GT(usable_s, kBeginS + kToBelieveS) << "it went on for a while";
    const control::DriveStep& end = log.steps.back();
    EXPECT_TRUE(stands(end.true_twist));
    EXPECT_LE(
        maps::distance(maps::position_of(end.true_pose), maps::position_of(end.estimated_pose)),
        0.05);
  }
}

}  // namespace
}  // namespace rovigo::app
