#pragma once
// Wheels, gyro and accelerometer of a rover on a known path, with the faults of real ones.

#include <Eigen/Core>
#include <cmath>
#include <deque>
#include <random>

#include "maps/geometry.h"
#include "slam/inertial_filter.h"

namespace rovigo::slam::test {

/// Stated noise is what the sensors have; slip and scales are shares.
struct SensorFaults {
  double speed_scale = 1.0;  ///< wheels report the true speed divided by this
  double turn_scale = 1.0;
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  double gyro_walk_rad_s2 = 0.0;
  double gyro_delay_s = 0.005;  ///< 0 .. 0.1; a sample is the mean of some time before its stamp
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();
  bool gyro = true, accelerometer = true, wheels = true;
  double gyro_sigma_rad_s = 0.003, accelerometer_sigma_m_s2 = 0.02;
  double wheel_sigma_m = 0.0;  ///< per square root of a second of motion: rubber and bumps
  double tick_m = 0.0;         ///< of the encoders; 0: exact
};

class SimulatedSensors : public SensorFaults {
 public:
  SimulatedSensors() = default;
  explicit SimulatedSensors(const SensorFaults& faults) : SensorFaults(faults) {}

  std::mt19937_64 random{7};

  TPose2D truth{}, odom{};
  double time_s = 10.0;
  double speed_m_s = 0.0, turn_rad_s = 0.0;

  /// How much more than the ground passes each side's wheels turn, as a share.
  double slip_left = 0.0, slip_right = 0.0;

  /// One hundredth of a second with speed and turn rate changing evenly to the given ones.
  void step(InertialFilter& filter, double new_speed, double new_turn) {
    constexpr double kDt = 0.01;
    const double speed = 0.5 * (speed_m_s + new_speed), turn = 0.5 * (turn_rad_s + new_turn);
    const double change = (new_speed - speed_m_s) / kDt;
    speed_m_s = new_speed;
    turn_rad_s = new_turn;
    turns_.push_front(new_turn);
    if (turns_.size() > 12) turns_.pop_back();
    time_s += kDt;
    truth = maps::compose(truth, {speed * kDt * std::cos(0.5 * turn * kDt),
                                  speed * kDt * std::sin(0.5 * turn * kDt), turn * kDt});
    roll_wheels(speed / speed_scale, turn / turn_scale, kDt);
    gyro_bias.z() += gyro_walk_rad_s2 * std::sqrt(kDt) * gaussian();
    if (gyro) {
      filter.add_gyro(time_s,
                      Eigen::Vector3d(0, 0, turned_before()) + gyro_bias + shake(gyro_sigma_rad_s));
    }
    if (accelerometer) {
      filter.add_accelerometer(time_s, Eigen::Vector3d(change, speed * turn, 9.81) +
                                           accelerometer_bias + shake(accelerometer_sigma_m_s2));
    }
    if (wheels && ++steps_ % 2 == 0) filter.add_wheels(time_s, read_wheels());
  }

  /// Runs `seconds` at a speed and turn rate, reached at 2 m/s^2 and 5 rad/s^2.
  void run(InertialFilter& filter, double seconds, double speed, double turn) {
    const int steps = static_cast<int>(std::lround(seconds * 100));
    for (int i = 0; i < steps; ++i) {
      step(filter, speed_m_s + std::clamp(speed - speed_m_s, -0.02, 0.02),
           turn_rad_s + std::clamp(turn - turn_rad_s, -0.05, 0.05));
    }
  }

  double position_error(const InertialFilter& filter) const {
    return maps::distance(maps::position_of(filter.map_from_base()), maps::position_of(truth));
  }
  double heading_error(const InertialFilter& filter) const {
    return std::abs(maps::wrap_angle(filter.map_from_base().phi - truth.phi));
  }
  double gaussian() { return std::normal_distribution<double>()(random); }

 private:
  static constexpr double kHalfTrackM = 0.179;

  /// The turn rate of one delay ago.
  double turned_before() const {
    const double steps = std::min(gyro_delay_s * 100, static_cast<double>(turns_.size()) - 1);
    const auto whole = static_cast<std::size_t>(steps);
    const double part = steps - static_cast<double>(whole);
    return part > 0 ? (1 - part) * turns_[whole] + part * turns_[whole + 1] : turns_[whole];
  }
  void roll_wheels(double speed, double turn, double dt) {
    const bool rolls = speed != 0.0 || turn != 0.0;
    const double rough = rolls ? wheel_sigma_m * std::sqrt(dt) * gaussian() : 0.0;
    left_m_ += rough + (speed - turn * kHalfTrackM) * (1.0 + slip_left) * dt;
    right_m_ += rough + (speed + turn * kHalfTrackM) * (1.0 + slip_right) * dt;
  }
  TPose2D read_wheels() {
    const double left = counted(left_m_), right = counted(right_m_);
    const double forward = 0.5 * (left - left_read_ + right - right_read_);
    const double turn = (right - right_read_ - left + left_read_) / (2 * kHalfTrackM);
    left_read_ = left;
    right_read_ = right;
    odom =
        maps::compose(odom, {forward * std::cos(0.5 * turn), forward * std::sin(0.5 * turn), turn});
    return odom;
  }
  double counted(double way) const { return tick_m > 0 ? std::floor(way / tick_m) * tick_m : way; }
  Eigen::Vector3d shake(double sigma) {
    const double x = gaussian(), y = gaussian(), z = gaussian();
    return sigma * Eigen::Vector3d(x, y, z);
  }

  double left_m_ = 0.0, right_m_ = 0.0, left_read_ = 0.0, right_read_ = 0.0;
  int steps_ = 0;
  std::deque<double> turns_;  ///< newest first
};

/// A look at the truth, as good as `sigma`s say.
inline PlanarInformation look_at(const TPose2D& truth, double sigma_m, double sigma_rad) {
  PlanarInformation look;
  look.map_from_base = truth;
  look.information.diagonal() << 1 / (sigma_m * sigma_m), 1 / (sigma_m * sigma_m),
      1 / (sigma_rad * sigma_rad);
  return look;
}

}  // namespace rovigo::slam::test
