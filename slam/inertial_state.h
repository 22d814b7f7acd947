#pragma once
// The state that wheels, gyro, accelerometer and looks share, with its covariance: an error-state
// Kalman filter (Sola 2017, "Quaternion kinematics for the error-state Kalman filter").

#include <Eigen/Core>
#include <span>

#include "slam/se3.h"

namespace rovigo::slam {

/// How uncertain the next moment is, as white noise per square root of a second unless said
/// otherwise.
struct InertialNoise {
  double turning_rad_s2 = 0.0;      ///< on the angular rate
  double jerk_m_s3 = 0.0;           ///< on the acceleration
  double gyro_walk_rad_s2 = 0.0;    ///< on the gyro's bias
  double delay_walk = 0.0;          ///< on the gyro's delay, seconds
  double accelerometer_walk = 0.0;  ///< on the accelerometer's bias, m/s^2
  double odometer_m2 = 0.0;         ///< variance that the step adds to the wheels' distance
  double wheel_turn_rad2 = 0.0;     ///< likewise to the wheels' turn
  double creep_m2 = 0.0;            ///< likewise to the position, across the heading
  double slip_m2 = 0.0;             ///< likewise along the heading, unseen by the wheels
  bool turn_by_wheels = false;      ///< no gyro: the rate about the vertical is the wheels'
  bool still = false;               ///< body at rest: only the biases walk
  bool speed_fades = false;         ///< nothing measures the speed: it reverts to rest
  bool turn_fades = false;          ///< nothing measures the turn rate about the vertical: likewise
  bool tilting_fades = false;       ///< or about the other axes
};

/// Position (map), attitude, velocity, angular rate and acceleration (body; the derivative of the
/// body's velocity): the 15 states of the thesis. Beyond them what the wheels should have counted
/// since their last reading (distance and turn: their readings then add up, however coarse the
/// encoders), the biases of gyro and accelerometer, how late the gyro tells of a turn, and the
/// wheels' scale errors in speed and turn.
class InertialState {
 public:
  static constexpr int kMoving = 17;  ///< states that change with motion; the others only walk
  static constexpr int kSize = 26;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  /// Where each part of the error starts; attitude: a small turn of the body.
  enum Index {
    kPosition = 0,
    kAttitude = 3,
    kVelocity = 6,
    kRate = 9,
    kAcceleration = 12,
    kOdometer = 15,
    kWheelTurn = 16,
    kGyroBias = 17,
    kAccelerometerBias = 20,
    kGyroDelay = 23,
    kSpeedScale = 24,
    kTurnScale = 25
  };

  Se3 map_from_base;
  /// Forwards in the wheels' own measure, as the acceleration: a change of speed then says nothing
  /// of their scale. Likewise the rate about the vertical where there is no gyro.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  double odometer_m = 0.0, wheel_turn_rad = 0.0;
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();
  double gyro_delay_s = 0.0;
  double speed_scale = 0.0, turn_scale = 0.0;
  Matrix covariance = Matrix::Zero();

  Eigen::Vector3d body_velocity() const { return scaled(velocity); }
  Eigen::Vector3d body_acceleration() const { return scaled(acceleration); }

  /// Carries the state on by `dt` seconds (short: first order in the error).
  void propagate(double dt, const InertialNoise& noise);
  /// Doubt of a velocity, rate or acceleration that came up `ago_s` seconds ago, and what it has
  /// done since to pose and wheel counts. It has nothing to do with biases and scales.
  void add_doubt(int index, double variance, double ago_s);

  /// The rate about the vertical changed by so much: the gyro told of it late by its delay.
  void make_up_delay(double rate_change_rad_s);

  /// Part of a measurement's derivative.
  struct Term {
    int index = 0;
    double derivative = 0.0;
  };
  double innovation_variance(std::span<const Term> terms, double variance) const;
  /// One scalar measurement of a sensor on board: `innovation` is measured minus predicted. The
  /// wheels' scales are considered, not taught (Schmidt 1966): only looks at the world show them,
  /// and a mere change of speed would bend them.
  void update(std::span<const Term> terms, double innovation, double variance);
  void inject(const Vector& error);

  /// Forgets how an error hangs together with the others and gives it `variance`.
  void reset_error(int index, double variance);

 private:
  using MovingMatrix = Eigen::Matrix<double, kMoving, kMoving>;
  using MovingByFixed = Eigen::Matrix<double, kMoving, kSize - kMoving>;
  void propagate_covariance(const MovingMatrix& by_moving, const MovingByFixed& by_fixed);
  Eigen::Vector3d scaled(const Eigen::Vector3d& v) const {
    return {v.x() * (1.0 + speed_scale), v.y(), v.z()};
  }
  void derivatives(double dt, bool turn_by_wheels, MovingMatrix& by_moving,
                   MovingByFixed& by_fixed) const;
  void add_noise(double dt, const InertialNoise& noise);
};

}  // namespace rovigo::slam
