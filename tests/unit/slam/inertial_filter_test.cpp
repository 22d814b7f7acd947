#include "slam/dead_reckoning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rovigo::slam {
namespace {

/// A rover with imperfect sensors on a known path.
struct Drive {
  double speed_scale = 1.0;  // wheels report the true speed divided by this
  double turn_scale = 1.0;
  double gyro_bias = 0.0;
  bool gyro = true;
  std::mt19937_64 random{7};

  TPose2D truth{};
  TPose2D odom{};
  double time_s = 10.0;

  /// Runs `seconds` at a speed and turn rate; wheels at 50 Hz, gyro at 100 Hz.
  void run(DeadReckoning& filter, double seconds, double speed, double turn,
           double slip_left = 0.0) {
    std::normal_distribution<double> noise(0.0, 0.003);
    const int steps = static_cast<int>(std::lround(seconds * 100));
    for (int i = 0; i < steps; ++i) {
      const double dt = 0.01;
      time_s += dt;
      truth = maps::compose(truth, {speed * dt * std::cos(0.5 * turn * dt),
                                    speed * dt * std::sin(0.5 * turn * dt), turn * dt});
      // A slipping left wheel turns faster than its side moves.
      const double left = (speed - turn * 0.179) * (1.0 + slip_left);
      const double right = speed + turn * 0.179;
      const double wheel_speed = 0.5 * (left + right) / speed_scale;
      const double wheel_turn = (right - left) / 0.358 / turn_scale;
      odom = maps::compose(odom,
                           {wheel_speed * dt * std::cos(0.5 * wheel_turn * dt),
                            wheel_speed * dt * std::sin(0.5 * wheel_turn * dt), wheel_turn * dt});
      if (gyro) filter.add_gyro(time_s, turn + gyro_bias + noise(random));
      if (i % 2 == 1) filter.add_wheels(time_s, odom);
    }
  }

  double position_error(const DeadReckoning& filter) const {
    return maps::distance(maps::position_of(filter.map_from_base()), maps::position_of(truth));
  }
  double heading_error(const DeadReckoning& filter) const {
    return std::abs(maps::wrap_angle(filter.map_from_base().phi - truth.phi));
  }
};

DeadReckoning started() {
  DeadReckoning filter{DeadReckoningConfig{}};
  filter.place({0, 0, 0}, 0.0, 0.0);
  return filter;
}

/// A look at the truth, as good as `sigma`s say.
PlanarInformation look_at(const TPose2D& truth, double sigma_m, double sigma_rad) {
  PlanarInformation look;
  look.map_from_base = truth;
  look.information.diagonal() << 1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m),
      1 / (sigma_rad * sigma_rad);
  return look;
}

TEST(DeadReckoning, PerfectSensorsFollowASquare) {
  DeadReckoning filter = started();
  Drive drive;
  for (int side = 0; side < 4; ++side) {
    drive.run(filter, 5.0, 0.4, 0.0);
    drive.run(filter, 2.0, 0.0, 1.5707963267948966 / 2.0);
  }
  EXPECT_LT(drive.position_error(filter), 0.03);
  EXPECT_LT(drive.heading_error(filter), 0.01);
}

TEST(DeadReckoning, StandingStillTeachesTheGyrosBias) {
  DeadReckoning filter = started();
  Drive drive{.gyro_bias = 0.01};
  drive.run(filter, 3.0, 0.0, 0.0);
  EXPECT_NEAR(filter.state()(DeadReckoning::kGyroBias), 0.01, 0.001);
  EXPECT_LT(drive.heading_error(filter), 1e-3);
}

TEST(DeadReckoning, LooksTeachTheWheelsScale) {
  DeadReckoning filter = started();
  Drive drive{.speed_scale = 1.03};
  for (int i = 0; i < 100; ++i) {
    drive.run(filter, 0.2, 0.4, 0.1);
    filter.correct(look_at(drive.truth, 0.01, 0.01), 0.0, 0.0);
  }
  EXPECT_NEAR(filter.state()(DeadReckoning::kSpeedScale), 0.03, 0.006);
  drive.run(filter, 10.0, 0.4, 0.0);  // 4 m without a look
  EXPECT_LT(drive.position_error(filter), 0.05);
}

TEST(DeadReckoning, LooksTeachTheTurnScaleWithoutAGyro) {
  DeadReckoning filter = started();
  Drive drive{.turn_scale = 0.95, .gyro = false};
  for (int i = 0; i < 100; ++i) {
    drive.run(filter, 0.2, 0.3, 0.5);
    filter.correct(look_at(drive.truth, 0.005, 0.003), 0.0, 0.0);
  }
  EXPECT_NEAR(filter.state()(DeadReckoning::kTurnScale), -0.05, 0.01);
}

TEST(DeadReckoning, ASlippingWheelIsNoticedAndTheOtherFollowed) {
  DeadReckoning filter = started();
  Drive drive;
  drive.run(filter, 2.0, 0.4, 0.0);
  const double before = drive.position_error(filter);
  drive.run(filter, 0.8, 0.4, 0.0, 0.5);
  EXPECT_TRUE(filter.slipping());
  // Unnoticed, the mean of both wheels would claim 25% of 0.32 m too much.
  EXPECT_LT(drive.position_error(filter) - before, 0.035);
  drive.run(filter, 1.0, 0.4, 0.0);
  EXPECT_FALSE(filter.slipping());
}

TEST(DeadReckoning, UncertaintyGrowsWithoutLooksAndShrinksWithThem) {
  DeadReckoning filter = started();
  Drive drive;
  drive.run(filter, 5.0, 0.4, 0.0);
  const double after_5s = filter.pose_covariance().trace();
  drive.run(filter, 5.0, 0.4, 0.0);
  const double after_10s = filter.pose_covariance().trace();
  EXPECT_GT(after_5s, 0.0);
  EXPECT_GT(after_10s, after_5s);
  filter.correct(look_at(drive.truth, 0.01, 0.01), 0.004, 0.002);
  EXPECT_LT(filter.pose_covariance().trace(), 0.2 * after_10s);
}

TEST(DeadReckoning, ALookThatConstrainsOneDirectionLeavesTheOtherAlone) {
  DeadReckoning filter = started();
  filter.place({0, 0, 0}, 0.1, 0.05);
  PlanarInformation corridor;  // sees the walls beside it, nothing along it
  corridor.map_from_base = {3.0, 0.05, 0.0};
  corridor.information(1, 1) = 1e6;
  filter.correct(corridor, 0.0, 0.0);
  EXPECT_NEAR(filter.map_from_base().x, 0.0, 1e-9);
  EXPECT_NEAR(filter.map_from_base().y, 0.05, 1e-4);
  EXPECT_NEAR(filter.pose_covariance()(0, 0), 0.01, 1e-9);
}

TEST(DeadReckoning, NonFiniteReadingsChangeNothing) {
  DeadReckoning filter = started();
  Drive drive;
  drive.run(filter, 1.0, 0.4, 0.0);
  const auto before = filter.state();
  filter.add_gyro(drive.time_s, std::nan(""));
  filter.add_wheels(drive.time_s, {std::nan(""), 0, 0});
  EXPECT_EQ(filter.state(), before);
}

TEST(DeadReckoning, ShiftingTheMapMovesThePoseWithIt) {
  DeadReckoning filter = started();
  filter.place({1, 0, 0}, 0.01, 0.01);
  filter.shift({0, 2, 1.5707963267948966});
  EXPECT_NEAR(filter.map_from_base().x, 0.0, 1e-9);
  EXPECT_NEAR(filter.map_from_base().y, 3.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::slam
