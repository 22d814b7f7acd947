// The six ways in which a drive must stop, through the closed loop that `drive` and `track` run.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/drive_outcome.h"
#include "app/simulated_drive.h"
#include "control/reference_drive.h"
#include "control/tracker.h"
#include "tests/support/run_rovigo.h"
#include "tests/unit/control/plant.h"
#include "tests/unit/control/simulated_drive.h"

namespace rovigo::app {
namespace {

constexpr double kFaultS = 4.0;  ///< since the recording's first moment; the rover is at full speed
constexpr double kFaultInLogS = kFaultS - kStandBeforeS;
constexpr double kStandingMS = 0.005, kStandingRadS = 0.02;

struct Case {
  std::string fault;
  control::StopCause cause;
  std::string status;
};

const std::vector<Case> kCases{
    {"poses_stall", control::StopCause::kNoPoses, "pose_lost"},
    {"poses_late", control::StopCause::kOldPoses, "pose_lost"},
    {"poses_not_finite", control::StopCause::kBadPoses, "pose_lost"},
    {"set_points_stop", control::StopCause::kNoSetPoints, "no_set_points"},
    {"battery_low", control::StopCause::kLowBattery, "battery_low"},
    {"manual_takeover", control::StopCause::kManual, "manual_takeover"},
};

struct FaultyDrive {
  sim::Scenario scenario;  // the default one: noise, late poses, slip
  double speed_m_s = 0.4;
  bool reference_law = false;
  planning::Trajectory plan;
};

control::DriveLog drive(const FaultyDrive& setup) {
  static const sim::World world = control::testing::empty_hall();
  RovigoConfig config;
  config.robot.max_speed_m_s = setup.speed_m_s;
  sim::SimulatorOptions options;
  options.robot = config.robot;
  options.scenario = setup.scenario;
  options.camera_enabled = false;
  sim::Simulator simulator(world, options);
  const auto poses = perturbed_poses(simulator, {}, setup.scenario, 1);
  std::unique_ptr<control::DriveController> controller =
      std::make_unique<control::TrajectoryTracker>(config.control, config.robot, setup.plan);
  if (setup.reference_law) {
    controller =
        std::make_unique<control::ReferenceDrive>(control::ReferenceConfig{}, setup.plan, 200.0);
  }
  return drive_in_simulator(simulator, {}, *poses, *controller, setup.plan.duration_s(), config,
                            {});
}

FaultyDrive setup_of(const Case& c, double duration_s, double speed_m_s = 0.4) {
  FaultyDrive setup;
  setup.speed_m_s = speed_m_s;
  sim::Fault fault;
  fault.kind = c.fault;
  fault.start_s = kFaultS;
  fault.duration_s = duration_s;
  setup.scenario.faults.push_back(fault);
  maps::RobotModel robot;
  robot.max_speed_m_s = speed_m_s;
  setup.plan = control::testing::TrajectoryBuilder(robot, {})
                   .drive(8.0 * speed_m_s, [](double s) { return 0.8 * std::sin(2.0 * s); })
                   .get();
  return setup;
}

struct Stop {
  double to_zero_s = 1e9;        ///< from the fault to the first zero command
  double to_standstill_s = 1e9;  ///< from that to rest
  double speed_m_s = 0.0;        ///< when the command became zero
};

bool is_zero(const TTwist2D& c) { return c.vx == 0.0 && c.omega == 0.0; }

Stop measure_stop(const control::DriveLog& log) {
  Stop stop;
  double zero_s = -1.0;
  for (const control::DriveStep& s : log.steps) {
    if (s.time_s < kFaultInLogS - 1e-9) continue;
    if (zero_s < 0.0 && is_zero(s.command)) {
      zero_s = s.time_s;
      stop.to_zero_s = zero_s - kFaultInLogS;
      stop.speed_m_s = std::abs(s.true_twist.vx);
    }
    if (zero_s < 0.0) continue;
    if (std::abs(s.true_twist.vx) < kStandingMS && std::abs(s.true_twist.omega) < kStandingRadS) {
      stop.to_standstill_s = s.time_s - zero_s;
      break;
    }
  }
  return stop;
}

TEST(SafetyStops, TheCommandIsZeroInTimeAndTheRoverStandsAtFullDeceleration) {
  for (const Case& c : kCases) {
    for (const double speed : {0.2, 0.8}) {
      for (const bool reference : {false, true}) {
        if (reference && speed != 0.2) continue;  // its own limit is 0.25 m/s
        FaultyDrive setup = setup_of(c, sim::Fault::kForGood, speed);
        setup.reference_law = reference;
        const control::DriveLog log = drive(setup);
        const Stop stop = measure_stop(log);
        const std::string name =
            c.fault + " at " + std::to_string(speed) + (reference ? " by the thesis's law" : "");
        RecordProperty(name, std::to_string(stop.to_zero_s) + " s, " +
                                 std::to_string(stop.to_standstill_s) + " s");
        EXPECT_LE(stop.to_zero_s, 0.2 + 1e-9) << name;
        EXPECT_GT(stop.speed_m_s, 0.5 * std::min(speed, reference ? 0.2 : speed)) << name;
        EXPECT_LE(stop.to_standstill_s, stop.speed_m_s / maps::RobotModel{}.max_acceleration_m_s2)
            << name;
        const TPose2D stood = log.steps.back().true_pose;
        for (const control::DriveStep& s : log.steps) {
          if (s.time_s < kFaultInLogS + 1.5) continue;
          ASSERT_TRUE(is_zero(s.command)) << name << " at " << s.time_s;
          ASSERT_LT(maps::distance(maps::position_of(s.true_pose), maps::position_of(stood)), 0.002)
              << name << ": it creeps";
        }
      }
    }
  }
}

TEST(SafetyStops, AfterAShortFaultTheDriveGoesOnToItsGoal) {
  for (const Case& c : kCases) {
    const FaultyDrive setup = setup_of(c, 3.0);
    const control::DriveLog log = drive(setup);
    const auto m = control::measure(log, setup.plan, setup.plan.points.back().pose, true);
    EXPECT_EQ(log.status, control::TrackStatus::kReached) << c.fault;
    EXPECT_EQ(log.held, control::StopCause::kNone) << c.fault;
    EXPECT_LE(m.cross_track_max_m, 0.05) << c.fault;
    EXPECT_LE(m.final_position_error_m, 0.03) << c.fault;
    bool held = false;
    for (const control::DriveStep& s : log.steps) held = held || s.held == c.cause;
    EXPECT_TRUE(held) << c.fault;
  }
}

TEST(SafetyStops, AHandThatHoldsTheRoverLongerThanPatienceForFaultsIsWaitedFor) {
  const FaultyDrive setup = setup_of(kCases.back(), 30.0);
  EXPECT_EQ(drive(setup).status, control::TrackStatus::kReached);
}

TEST(SafetyStops, AFaultForGoodEndsTheDriveAndItsMessageNamesTheCause) {
  for (const Case& c : kCases) {
    const FaultyDrive setup = setup_of(c, sim::Fault::kForGood);
    const control::DriveLog log = drive(setup);
    const auto m = control::measure(log, setup.plan, setup.plan.points.back().pose, true);
    EXPECT_EQ(log.held, c.cause) << c.fault;
    const Outcome outcome = outcome_of(log, m);
    EXPECT_EQ(outcome.status, c.status) << c.fault;
    EXPECT_NE(outcome.code, 0) << c.fault;
  }
}

TEST(SafetyStops, TheCommandLineEndsWithOneAndNamesTheCause) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "dead.yaml",
                   "faults: [{kind: set_points_stop, start_s: 3, within_s: 1}]\n");
  test::write_text(folder / "suite.yaml",
                   "trajectories: {line: {length_m: 2}}\ngroups: [{name: g, "
                   "scenario: \"" +
                       folder / "dead.yaml" + "\"}]\n");
  const auto tracked = test::run_rovigo({"track", folder / "suite.yaml", "--json"});
  EXPECT_EQ(tracked.exit_code, 1) << tracked.err;
  const auto run = nlohmann::json::parse(tracked.out).at("runs").at(0);
  EXPECT_EQ(run.at("status"), "no_set_points");

  test::write_text(
      folder / "hall.map", "type octile\nheight 8\nwidth 12\nmap\n" + [] {
        std::string rows;
        for (int i = 0; i < 8; ++i) rows += "............\n";
        return rows;
      }());
  test::write_text(folder / "flat.yaml", "faults: [{kind: battery_low, start_s: 4}]\n");
  const auto driven =
      test::run_rovigo({"drive", folder / "hall.map", "--start", "2,4,0", "--goal", "9,4", "--pose",
                        "perturbed", "--scenario", folder / "flat.yaml", "--json"});
  EXPECT_EQ(driven.exit_code, 1) << driven.err;
  const auto object = nlohmann::json::parse(driven.out);
  EXPECT_EQ(object.at("status"), "battery_low");
  EXPECT_THAT(object.at("message").get<std::string>(), testing::HasSubstr("battery"));
}

}  // namespace
}  // namespace rovigo::app
