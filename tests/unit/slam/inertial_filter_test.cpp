#include "slam/inertial_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/simulated_sensors.h"

namespace rovigo::slam {
namespace {

using test::look_at;
using test::SimulatedSensors;

InertialFilter started() {
  InertialFilter filter{DeadReckoningConfig{}};
  filter.place({0, 0, 0}, 0.0, 0.0);
  return filter;
}

TEST(InertialFilter, PerfectSensorsFollowASquare) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 1.0, 0.0, 0.0);
  for (int side = 0; side < 4; ++side) {
    drive.run(filter, 5.0, 0.4, 0.0);
    drive.run(filter, 2.0, 0.0, 1.5707963267948966 / 2.0);
  }
  EXPECT_LT(drive.position_error(filter), 0.03);
  EXPECT_LT(drive.heading_error(filter), 0.01);
}

TEST(InertialFilter, StandingStillTeachesTheGyrosBias) {
  InertialFilter filter = started();
  SimulatedSensors drive({.gyro_bias = {0, 0, 0.01}});
  drive.run(filter, 3.0, 0.0, 0.0);
  EXPECT_NEAR(filter.state().gyro_bias.z(), 0.01, 0.001);
  EXPECT_LT(drive.heading_error(filter), 1e-3);
}

TEST(InertialFilter, LooksTeachTheWheelsScale) {
  InertialFilter filter = started();
  SimulatedSensors drive({.speed_scale = 1.03});
  for (int i = 0; i < 100; ++i) {
    drive.run(filter, 0.2, 0.4, 0.1);
    filter.correct(look_at(drive.truth, 0.01, 0.01), 0.0, 0.0);
  }
  EXPECT_NEAR(filter.state().speed_scale, 0.03, 0.006);
  drive.run(filter, 10.0, 0.4, 0.0);  // 4 m without a look
  EXPECT_LT(drive.position_error(filter), 0.05);
}

TEST(InertialFilter, LooksTeachTheTurnScaleWithoutAGyro) {
  InertialFilter filter = started();
  SimulatedSensors drive({.turn_scale = 0.95, .gyro = false, .accelerometer = false});
  for (int i = 0; i < 100; ++i) {
    drive.run(filter, 0.2, 0.3, 0.5);
    filter.correct(look_at(drive.truth, 0.005, 0.003), 0.0, 0.0);
  }
  EXPECT_NEAR(filter.state().turn_scale, -0.05, 0.01);
}

TEST(InertialFilter, LooksTeachHowLateTheGyroTells) {
  for (const double delay_s : {0.0, 0.014}) {
    InertialFilter filter = started();
    SimulatedSensors drive({.gyro_delay_s = delay_s});
    for (int i = 0; i < 60; ++i) {
      drive.run(filter, 0.2, 0.2, i % 10 < 5 ? 1.2 : -1.2);
      filter.correct(look_at(drive.truth, 0.005, 0.003), 0.0, 0.0);
    }
    EXPECT_NEAR(filter.state().gyro_delay_s, delay_s, 0.001);
    drive.run(filter, 1.0, 0.0, 0.0);
    filter.place(drive.truth, 0.0, 0.0);
    drive.run(filter, 0.5, 0.0, 1.5);  // without a look
    EXPECT_LT(drive.heading_error(filter), 0.003) << "of a turn told " << delay_s << " s late";
  }
}

TEST(InertialFilter, AGyroOfUnknownDelayLeavesTurnsUncertain) {
  const auto sigma_in_turn = [](double delay_sigma_s) {
    DeadReckoningConfig config;
    config.gyro_delay_sigma_s = delay_sigma_s;
    InertialFilter filter{config};
    filter.place({0, 0, 0}, 0.0, 0.0);
    SimulatedSensors drive;
    drive.run(filter, 2.0, 0.0, 0.0);
    drive.run(filter, 0.5, 0.0, 1.5);
    return std::sqrt(filter.pose_covariance()(2, 2));
  };
  EXPECT_GT(sigma_in_turn(0.01), 0.012);  // 1.5 rad/s for 10 ms
  EXPECT_LT(sigma_in_turn(0.0), 0.004);
}

TEST(InertialFilter, ASlippingWheelIsNoticedAndTheOtherFollowed) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 2.0, 0.4, 0.0);
  const double before = drive.position_error(filter);
  drive.slip_left = 0.5;
  drive.run(filter, 0.8, 0.4, 0.0);
  EXPECT_TRUE(filter.slipping());
  // Unnoticed, the mean of both wheels would claim 25% of 0.32 m too much.
  EXPECT_LT(drive.position_error(filter) - before, 0.035);
  drive.slip_left = 0.0;
  drive.run(filter, 1.0, 0.4, 0.0);
  EXPECT_FALSE(filter.slipping());
}

TEST(InertialFilter, BothSidesSpinningAreNoticedByTheAccelerometer) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 2.0, 0.0, 0.0);  // rest shows what the accelerometer reads wrongly
  drive.run(filter, 2.0, 0.3, 0.0);
  EXPECT_FALSE(filter.slipping());
  const double before = drive.position_error(filter);
  drive.slip_left = drive.slip_right = 1.0;
  drive.run(filter, 0.6, 0.3, 0.0);
  EXPECT_TRUE(filter.slipping());
  // Unnoticed, the wheels would claim another 0.18 m.
  EXPECT_LT(drive.position_error(filter) - before, 0.06);
  drive.slip_left = drive.slip_right = 0.0;
  drive.run(filter, 1.0, 0.3, 0.0);
  EXPECT_FALSE(filter.slipping());
}

TEST(InertialFilter, BlockedWheelsOfASlidingRoverAreNotBelieved) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 2.0, 0.0, 0.0);
  drive.run(filter, 2.0, 0.5, 0.0);
  drive.slip_left = drive.slip_right = -1.0;
  drive.run(filter, 0.15, 0.5, 0.0);
  EXPECT_TRUE(filter.slipping());
  EXPECT_NEAR(filter.twist().vx, 0.5, 0.1);
}

TEST(InertialFilter, WheelsAloneStillDeadReckon) {
  InertialFilter filter = started();
  SimulatedSensors drive({.gyro = false, .accelerometer = false, .tick_m = 4.5e-4});
  for (int side = 0; side < 4; ++side) {
    drive.run(filter, 5.0, 0.4, 0.0);
    drive.run(filter, 2.0, 0.0, 1.5707963267948966 / 2.0);
  }
  // What encoders count adds up: no error of a tick is ever added twice.
  EXPECT_LT(drive.position_error(filter), 0.03);
  EXPECT_LT(drive.heading_error(filter), 0.01);
}

TEST(InertialFilter, WithoutWheelsLooksTeachTheSpeed) {
  InertialFilter filter = started();
  SimulatedSensors drive({.wheels = false});
  for (int i = 0; i < 60; ++i) {
    drive.run(filter, 0.07, 0.4, 0.2);
    filter.correct(look_at(drive.truth, 0.002, 0.002), 0.0, 0.0);
  }
  EXPECT_NEAR(filter.twist().vx, 0.4, 0.05);
  EXPECT_NEAR(filter.twist().omega, 0.2, 0.02);
}

TEST(InertialFilter, RestTeachesTheAccelerometersBias) {
  InertialFilter filter = started();
  SimulatedSensors drive({.accelerometer_bias = {0.0, 0.0, 0.1}});
  drive.run(filter, 5.0, 0.0, 0.0);
  EXPECT_NEAR(filter.state().accelerometer_bias.z(), 0.1, 0.02);
}

TEST(InertialFilter, SilentWheelsLeaveThePoseMoreAndMoreUncertain) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 3.0, 0.3, 0.0);
  const double before = filter.pose_covariance()(0, 0);
  filter.advance_to(drive.time_s + 5.0);
  EXPECT_GT(filter.pose_covariance()(0, 0), before + 0.05);
  EXPECT_TRUE(filter.state().covariance.allFinite());
}

TEST(InertialFilter, TurningOnRestingWheelsIsBeingCarried) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 2.0, 0.0, 0.0);
  drive.slip_left = drive.slip_right = -1.0;  // the wheels hang in the air
  drive.run(filter, 1.0, 0.0, 0.6);
  EXPECT_TRUE(filter.carried());
}

TEST(InertialFilter, ACarriedRoverNeitherFliesOffNorForgetsItsWheels) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 2.0, 0.3, 0.0);
  drive.run(filter, 2.0, 0.0, 0.0);
  drive.slip_left = drive.slip_right = -1.0;
  drive.run(filter, 3.0, 1.2, 0.7);  // somebody walks off with it
  drive.run(filter, 2.0, 0.0, 0.0);
  drive.slip_left = drive.slip_right = 0.0;
  EXPECT_TRUE(filter.carried());
  EXPECT_NEAR(filter.twist().vx, 0.0, 0.05);
  EXPECT_NEAR(filter.state().speed_scale, 0.0, 0.05);
  filter.place(drive.truth, 0.05, 0.03);
  drive.run(filter, 5.0, 0.4, 0.0);
  EXPECT_LT(drive.position_error(filter), 0.1);
}

TEST(InertialFilter, UncertaintyGrowsWithoutLooksAndShrinksWithThem) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 5.0, 0.4, 0.0);
  const double after_5s = filter.pose_covariance().trace();
  drive.run(filter, 5.0, 0.4, 0.0);
  const double after_10s = filter.pose_covariance().trace();
  EXPECT_GT(after_5s, 0.0);
  EXPECT_GT(after_10s, after_5s);
  filter.correct(look_at(drive.truth, 0.01, 0.01), 0.004, 0.002);
  EXPECT_LT(filter.pose_covariance().trace(), 0.2 * after_10s);
}

TEST(InertialFilter, ALookThatConstrainsOneDirectionLeavesTheOtherAlone) {
  InertialFilter filter = started();
  filter.place({0, 0, 0}, 0.1, 0.05);
  PlanarInformation corridor;  // sees the walls beside it, nothing along it
  corridor.map_from_base = {3.0, 0.05, 0.0};
  corridor.information(1, 1) = 1e6;
  filter.correct(corridor, 0.0, 0.0);
  EXPECT_NEAR(filter.map_from_base().x, 0.0, 1e-9);
  EXPECT_NEAR(filter.map_from_base().y, 0.05, 1e-4);
  EXPECT_NEAR(filter.pose_covariance()(0, 0), 0.01, 1e-9);
}

TEST(InertialFilter, NonFiniteReadingsChangeNothing) {
  InertialFilter filter = started();
  SimulatedSensors drive;
  drive.run(filter, 1.0, 0.4, 0.0);
  const auto before = filter.state().covariance;
  const TPose2D pose = filter.map_from_base();
  filter.add_gyro(drive.time_s, {0, 0, std::nan("")});
  filter.add_accelerometer(drive.time_s, {0, std::nan(""), 9.81});
  filter.add_wheels(drive.time_s, {std::nan(""), 0, 0});
  EXPECT_EQ(filter.state().covariance, before);
  EXPECT_EQ(filter.map_from_base(), pose);
}

TEST(InertialFilter, ShiftingTheMapMovesThePoseWithIt) {
  InertialFilter filter = started();
  filter.place({1, 0, 0}, 0.01, 0.01);
  filter.shift({0, 2, 1.5707963267948966});
  EXPECT_NEAR(filter.map_from_base().x, 0.0, 1e-9);
  EXPECT_NEAR(filter.map_from_base().y, 3.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::slam
