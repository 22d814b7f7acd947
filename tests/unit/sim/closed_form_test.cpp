// Each effect of the simulator by itself against what mechanics says, on paper.
//
// Tolerances: the physics takes steps of 1/240 s in single precision, so a time is known to a step
// and a speed to some tenths of a percent; what is wider says why.

#include <gtest/gtest.h>

#include <cmath>

#include "test_worlds.h"

namespace rovigo::sim {
namespace {

constexpr double kG = 9.81;

Simulator on_bare_floor(const Scenario& scenario, const maps::RobotModel& robot = {}) {
  SimulatorOptions options = blind_options(scenario);
  options.robot = robot;
  return {World(bare_floor()), options};
}

/// What resists being sped up, the spinning wheels (spheres) included.
double effective_mass_kg(const maps::RobotModel& robot, double payload_kg = 0.0) {
  return robot.mass_kg + payload_kg + 4.0 * 0.4 * robot.wheel_mass_kg;
}

/// Motors so weak that they, and not the speed loop, say how the rover moves.
maps::RobotModel weak_robot() {
  maps::RobotModel robot;
  robot.motor_stall_torque_nm = 0.2;
  return robot;
}

/// Uphill along x, on motors whose speed loop has no lag and whose gears have this friction.
Scenario slope_of(double angle_deg, double friction_nm = 0.05) {
  Scenario s = ideal_scenario();
  s.slope.angle_deg = angle_deg;
  s.motor.friction_nm = friction_nm;
  s.motor.lag_s = 0.0;
  return s;
}

/// Speed at which a weak motor's torque is just what friction and the slope take.
double balance_speed(const maps::RobotModel& robot, const Scenario& s) {
  const double weight_n = robot.mass_kg * kG * std::sin(s.slope.angle_deg * maps::kPi / 180.0);
  const double load_nm = weight_n * robot.wheel_radius_m / 4.0 + s.motor.friction_nm;
  return robot.motor_no_load_speed_m_s *
         (s.motor.voltage_share - load_nm / robot.motor_stall_torque_nm);
}

TEST(ClosedForm, ACommandedTwistIsAnArcOfItsRadiusAndAngle) {
  for (const auto& [v, w] : {std::pair{0.3, 0.5}, {0.4, -0.8}, {0.2, 0.25}}) {
    Simulator simulator = on_bare_floor(ideal_scenario());
    drive(simulator, {v, 0.0, w}, 1.0);
    const TPose2D from = true_pose(simulator);
    constexpr double kSeconds = 2.0;
    drive(simulator, {v, 0.0, w}, kSeconds);
    const TPose2D to = true_pose(simulator);
    const double turned = maps::wrap_angle(to.phi - from.phi);
    const double chord = maps::distance(maps::position_of(from), maps::position_of(to));
    const double radius = chord / (2.0 * std::sin(std::abs(turned) / 2.0));
    // The tyres scrub, which the wheels' speed loop takes out but for a percent.
    EXPECT_NEAR(turned, w * kSeconds, 0.015 * std::abs(w) * kSeconds);
    EXPECT_NEAR(radius, v / std::abs(w), 0.015 * v / std::abs(w));
  }
}

TEST(ClosedForm, ATurnInPlaceTurnsByRateTimesTimeOnTheSpot) {
  for (const double w : {0.5, -1.0}) {
    Simulator simulator = on_bare_floor(ideal_scenario());
    drive(simulator, {0.0, 0.0, w}, 1.0);
    const TPose2D from = true_pose(simulator);
    drive(simulator, {0.0, 0.0, w}, 2.0);
    EXPECT_NEAR(maps::wrap_angle(true_pose(simulator).phi - from.phi), 2.0 * w,
                0.015 * std::abs(2.0 * w));
    EXPECT_LT(maps::distance(maps::position_of(from), maps::position_of(true_pose(simulator))),
              0.005);
  }
}

TEST(ClosedForm, WithoutPowerItCoastsDownByTheGearsFriction) {
  Scenario s = ideal_scenario();
  s.motor.friction_nm = 0.06;
  s.faults.push_back({.kind = "battery_low", .start_s = 2.0, .voltage_share = 0.0});
  Simulator simulator = on_bare_floor(s);
  drive(simulator, {0.6, 0.0, 0.0}, 2.0);
  const double v0 = simulator.truth().twist.vx;
  const double x0 = true_pose(simulator).x;
  const double deceleration =
      4.0 * 0.06 / maps::RobotModel{}.wheel_radius_m / effective_mass_kg(maps::RobotModel{});
  drive(simulator, {0.6, 0.0, 0.0}, 0.5);  // whatever is commanded
  EXPECT_NEAR(simulator.truth().twist.vx, v0 - 0.5 * deceleration, 0.01 * v0);
  drive(simulator, {0.6, 0.0, 0.0}, 2.0);
  EXPECT_NEAR(simulator.truth().twist.vx, 0.0, 1e-3);
  const double distance = v0 * v0 / (2.0 * deceleration);
  EXPECT_NEAR(true_pose(simulator).x - x0, distance, 0.015 * distance);
}

TEST(ClosedForm, AtStallTorqueItGainsSpeedAsItsMassSays) {
  maps::RobotModel robot = weak_robot();
  Scenario s = slope_of(0.0);
  for (const double payload_kg : {0.0, 3.0}) {
    s.payload.mass_kg = payload_kg;
    Simulator simulator = on_bare_floor(s, robot);
    constexpr double kSeconds = 0.4;
    drive(simulator, {0.9, 0.0, 0.0}, kSeconds);
    // v' = a - v / T: a at rest, and the torque's fall with speed.
    const double per_torque = 4.0 / robot.wheel_radius_m / effective_mass_kg(robot, payload_kg);
    const double a = per_torque * (robot.motor_stall_torque_nm - s.motor.friction_nm);
    const double rate = per_torque * robot.motor_stall_torque_nm / robot.motor_no_load_speed_m_s;
    EXPECT_NEAR(simulator.truth().twist.vx, a / rate * (1.0 - std::exp(-rate * kSeconds)),
                0.02 * a * kSeconds)
        << payload_kg << " kg";
  }
}

TEST(ClosedForm, TheTorqueSpeedCurveHoldsAtTwoLoadsAndTwoVoltages) {
  const maps::RobotModel robot = weak_robot();
  for (const double angle_deg : {0.0, 5.0}) {
    for (const double voltage_share : {1.0, 0.8}) {
      Scenario s = slope_of(angle_deg);
      s.motor.voltage_share = voltage_share;
      Simulator simulator = on_bare_floor(s, robot);
      drive(simulator, {1.0, 0.0, 0.0}, 8.0);  // time constant: 0.5 s
      EXPECT_NEAR(simulator.truth().twist.vx, balance_speed(robot, s), 0.005)
          << angle_deg << " deg, " << voltage_share;
    }
  }
}

TEST(ClosedForm, AMotorWeakerThanTheSlopeStandsAndDoesNotRollBack) {
  maps::RobotModel robot;
  robot.motor_stall_torque_nm = 0.1;  // 5 deg take 0.087 Nm of each wheel, the gears 0.05
  Simulator simulator = on_bare_floor(slope_of(5.0), robot);
  drive(simulator, {0.4, 0.0, 0.0}, 3.0);
  EXPECT_NEAR(true_pose(simulator).x, 0.0, 0.002);
}

TEST(ClosedForm, ParkedOnASlopeItStandsHoweverItIsTurned) {
  for (const double uphill_deg : {0.0, 90.0, 135.0, 180.0}) {
    Scenario s = slope_of(5.0);
    s.slope.uphill_deg = uphill_deg;
    Simulator simulator = on_bare_floor(s);
    const TPose2D from = true_pose(simulator);
    drive(simulator, {0.9 * s.motor.dead_zone_m_s, 0.0, 0.0}, 20.0);  // below stiction
    EXPECT_LT(maps::distance(maps::position_of(from), maps::position_of(true_pose(simulator))),
              0.001)
        << uphill_deg;
    EXPECT_NEAR(true_pose(simulator).phi, 0.0, 0.002) << uphill_deg;
  }
}

TEST(ClosedForm, WithoutPowerTheGearsHoldItOnTheSlopeUpToTheirFriction) {
  for (const double friction_nm : {0.08, 0.10}) {  // 5 deg take 0.087 Nm of each wheel
    Scenario s = slope_of(5.0, friction_nm);
    s.motor.voltage_share = 0.0;
    Simulator simulator = on_bare_floor(s);
    const double x0 = true_pose(simulator).x;
    drive(simulator, {}, 2.0);
    const double need_nm = 6.5 * kG * std::sin(5.0 * maps::kPi / 180.0) * 0.0625 / 4.0;
    const double per_torque = 4.0 / 0.0625 / effective_mass_kg({});
    const double a = per_torque * std::max(0.0, need_nm - friction_nm);
    EXPECT_NEAR(x0 - true_pose(simulator).x, 0.5 * a * 4.0, 0.03 * 0.5 * a * 4.0 + 0.001);
  }
}

TEST(ClosedForm, AcrossASlopeItDriftsDownAtTheSpeedTheTyresScrub) {
  Scenario s = slope_of(5.0);
  s.slope.uphill_deg = 90.0;  // to the left
  Simulator simulator = on_bare_floor(s);
  drive(simulator, {0.4, 0.0, 0.0}, 1.0);
  const maps::RobotModel robot;
  const double side_n = robot.mass_kg * kG * std::sin(5.0 * maps::kPi / 180.0);
  EXPECT_NEAR(simulator.truth().twist.vy, -side_n / (4.0 * robot.tire_scrub_n_s_m), 5e-4);
}

TEST(ClosedForm, TheImuFeelsTheSlope) {
  Scenario s = slope_of(5.0);
  s.slope.uphill_deg = 30.0;
  Simulator simulator = on_bare_floor(s);
  drive(simulator, {}, 0.5);
  const auto imu = only<mrpt::obs::CObservationIMU>(simulator.take_observations());
  const double sin = std::sin(5.0 * maps::kPi / 180.0);
  const double cos = std::cos(5.0 * maps::kPi / 180.0);
  constexpr double kFelt = 0.02;  // m/s^2: the tyres still bend a little
  EXPECT_NEAR(imu.back()->get(mrpt::obs::IMU_X_ACC), kG * sin * std::cos(maps::kPi / 6), kFelt);
  EXPECT_NEAR(imu.back()->get(mrpt::obs::IMU_Y_ACC), kG * sin * std::sin(maps::kPi / 6), kFelt);
  EXPECT_NEAR(imu.back()->get(mrpt::obs::IMU_Z_ACC), kG * cos, kFelt);
}

TEST(ClosedForm, TheSpeedLoopFollowsWithItsTimeConstant) {
  Scenario s = ideal_scenario();
  s.motor.lag_s = 0.2;
  Simulator simulator = on_bare_floor(s);
  for (const double seconds : {0.1, 0.2, 0.4}) {
    Simulator one = on_bare_floor(s);
    drive(one, {0.3, 0.0, 0.0}, seconds);
    // A step late, and the loop's integral action: 2 % of the step.
    EXPECT_NEAR(one.truth().twist.vx, 0.3 * (1.0 - std::exp(-seconds / 0.2)), 0.006) << seconds;
  }
}

TEST(ClosedForm, OnIceItGainsSpeedAsFrictionSaysAndItsWheelsSpin) {
  Scenario ice = ideal_scenario();
  ice.grip = {.slippery_share = 1.0, .patch_m = 0.4, .slippery_grip = 0.03};
  Simulator simulator = on_bare_floor(ice);
  constexpr double kSeconds = 0.5;
  drive(simulator, {0.4, 0.0, 0.0}, kSeconds);
  const double a = maps::RobotModel{}.tire_friction * 0.03 * kG;
  EXPECT_NEAR(simulator.truth().twist.vx, a * kSeconds, 0.05 * a * kSeconds);
  const auto wheels = only<mrpt::obs::CObservationOdometry>(simulator.take_observations());
  EXPECT_NEAR(wheels.back()->velocityLocal.vx, 0.4, 0.02);
}

TEST(ClosedForm, ALoadToTheLeftTurnsAWeakStartToTheLeft) {
  // Both sides push alike, the mass is to the left of the push: the rover turns towards the mass.
  Scenario s = slope_of(0.0);
  s.payload = {.mass_kg = 3.0, .forward_m = 0.0, .left_m = 0.1, .up_m = 0.25};
  Simulator loaded = on_bare_floor(s, weak_robot());
  drive(loaded, {0.9, 0.0, 0.0}, 0.3);
  EXPECT_GT(true_pose(loaded).phi, 1e-3);
  s.payload.left_m = 0.0;
  Simulator even = on_bare_floor(s, weak_robot());
  drive(even, {0.9, 0.0, 0.0}, 0.3);
  EXPECT_NEAR(true_pose(even).phi, 0.0, 1e-4);
}

}  // namespace
}  // namespace rovigo::sim
