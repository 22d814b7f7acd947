// Is the filter's covariance honest? Normalised estimation error squared (NEES; Bar-Shalom, Li &
// Kirubarajan 2001, section 5.4) of (x, y, yaw) over random drives: 3 on average when it is.

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/support/simulated_sensors.h"

namespace rovigo::slam {
namespace {

using test::look_at;
using test::SimulatedSensors;

constexpr int kSeeds = 24;
constexpr int kRounds = 4;  // looks, then blind, per drive
constexpr double kLookSigmaM = 0.008, kLookSigmaRad = 0.004;

struct Conditions {
  double slips_per_minute = 0.0;
  bool gyro = true, accelerometer = true;
};

struct Nees {
  double looking = 0.0, blind = 0.0;
  int looks = 0, blind_ends = 0;
};

double nees(const InertialFilter& filter, const TPose2D& truth) {
  const TPose2D pose = filter.map_from_base();
  const Eigen::Vector3d error(pose.x - truth.x, pose.y - truth.y,
                              maps::wrap_angle(pose.phi - truth.phi));
  return error.dot(filter.pose_covariance().inverse() * error);
}

/// A driver who changes his mind, and floors on which wheels slip now and then.
class RandomDrive {
 public:
  RandomDrive(std::uint64_t seed, const Conditions& conditions)
      : conditions_(conditions), random_(seed) {
    sensors_.random.seed(seed + 1000);
    sensors_.gyro = conditions.gyro;
    sensors_.accelerometer = conditions.accelerometer;
    sensors_.speed_scale = 1.0 + 0.02 * gaussian();
    sensors_.turn_scale = 1.0 + 0.03 * gaussian();
    sensors_.gyro_bias = 0.01 * Eigen::Vector3d(gaussian(), gaussian(), gaussian());
    sensors_.accelerometer_bias = 0.06 * Eigen::Vector3d(gaussian(), gaussian(), gaussian());
    sensors_.gyro_walk_rad_s2 = 1e-4;
    sensors_.gyro_delay_s = std::clamp(0.005 + 0.005 * gaussian(), 0.0, 0.02);
    sensors_.tick_m = 4.5e-4;
    sensors_.wheel_sigma_m = DeadReckoningConfig{}.wheel_speed_sigma_m_s * std::sqrt(0.02);
    filter_.place({kLookSigmaM * gaussian(), kLookSigmaM * gaussian(), kLookSigmaRad * gaussian()},
                  kLookSigmaM, kLookSigmaRad);
  }

  void run(Nees& sum) {
    for (int round = 0; round < kRounds; ++round) {
      for (int i = 0; i < 1000; ++i) {  // 10 s
        step();
        if (i % 7 != 0) continue;
        look();
        sum.looking += nees(filter_, sensors_.truth);
        ++sum.looks;
      }
      for (int i = 0; i < 500; ++i) step();
      sum.blind += nees(filter_, sensors_.truth);
      ++sum.blind_ends;
    }
  }

 private:
  double gaussian() { return std::normal_distribution<double>()(random_); }
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  void step() {
    if (--steps_left_ <= 0) {
      steps_left_ = static_cast<int>(uniform(50, 300));
      const bool rests = uniform(0, 1) < 0.1;
      speed_ = rests ? 0.0 : uniform(-0.1, 0.5);
      turn_ = rests ? 0.0 : uniform(-1.0, 1.0);
    }
    slip();
    // A motor approaches what it was told, with a lag of 0.2 s, until friction stops it.
    const double speed = towards(sensors_.speed_m_s, speed_);
    sensors_.step(filter_, speed, towards(sensors_.turn_rad_s, turn_));
  }
  static double towards(double now, double wanted) {
    return std::abs(wanted - now) < 0.02 ? wanted : now + 0.05 * (wanted - now);
  }

  void slip() {
    if (slip_left_ > 0) {
      if (--slip_left_ == 0) sensors_.slip_left = sensors_.slip_right = 0.0;
      return;
    }
    if (uniform(0, 6000) >= conditions_.slips_per_minute) return;
    slip_left_ = static_cast<int>(uniform(20, 80));
    const double side = uniform(0, 3), share = uniform(0.2, 0.8);
    if (side < 2) sensors_.slip_left = share;  // left alone, both, or right alone
    if (side > 1) sensors_.slip_right = share;
  }

  void look() {
    const double x = gaussian(), y = gaussian(), yaw = gaussian();
    const TPose2D seen{sensors_.truth.x + kLookSigmaM * x, sensors_.truth.y + kLookSigmaM * y,
                       sensors_.truth.phi + kLookSigmaRad * yaw};
    filter_.correct(look_at(seen, kLookSigmaM, kLookSigmaRad), 0.0, 0.0);
  }

  Conditions conditions_;
  std::mt19937_64 random_;
  SimulatedSensors sensors_;
  InertialFilter filter_{DeadReckoningConfig{}};
  int steps_left_ = 0, slip_left_ = 0;
  double speed_ = 0.0, turn_ = 0.0;
};

Nees average(const Conditions& conditions) {
  Nees sum;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomDrive(seed, conditions).run(sum);
  }
  sum.looking /= sum.looks;
  sum.blind /= sum.blind_ends;
  return sum;
}

TEST(InertialFilterHonesty, WithWheelsGyroAndAccelerometer) {
  const Nees mean = average({});
  RecordProperty("looking", std::to_string(mean.looking));
  EXPECT_GT(mean.looking, 1.5);
  EXPECT_LT(mean.looking, 4.5);
  EXPECT_GT(mean.blind, 1.5);
  EXPECT_LT(mean.blind, 4.5);
}

TEST(InertialFilterHonesty, WithoutAccelerometer) {
  const Nees mean = average({.accelerometer = false});
  EXPECT_GT(mean.looking, 1.5);
  EXPECT_LT(mean.looking, 4.5);
  EXPECT_GT(mean.blind, 1.5);
  EXPECT_LT(mean.blind, 4.5);
}

TEST(InertialFilterHonesty, WithWheelsAloneItIsNotTooSure) {
  const Nees mean = average({.gyro = false, .accelerometer = false});
  EXPECT_LT(mean.looking, 4.5);
  EXPECT_LT(mean.blind, 4.5);
}

TEST(InertialFilterHonesty, SlippingWheelsDoNotMakeItTooSure) {
  const Nees mean = average({.slips_per_minute = 4.0});
  EXPECT_LT(mean.looking, 9.0);
  EXPECT_LT(mean.blind, 9.0);
}

}  // namespace
}  // namespace rovigo::slam
