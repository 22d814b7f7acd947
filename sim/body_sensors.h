#pragma once
// Gyro, accelerometer and wheel encoders: what they make of the body's true motion.

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <Eigen/Core>

#include "maps/robot_model.h"
#include "sim/random.h"
#include "sim/rover.h"
#include "sim/scenario.h"

namespace rovigo::sim {

/// Sits in base_link. Biases are drawn once by seed; the gyro's walks slowly.
class ImuSensor {
 public:
  ImuSensor(const ImuNoise& noise, const Eigen::Vector3d& gravity, std::uint64_t seed);

  /// The body's motion after each physics step.
  void advance(const BodyState& state);

  /// One sample over the interval since the previous one: the mean turn rate of its steps, and the
  /// specific force (change of velocity over `interval_s`, minus gravity).
  mrpt::obs::CObservationIMU::Ptr sample(const BodyState& state, double interval_s);

  /// Forgets the previous velocity (after the rover was carried).
  void reset_motion(const BodyState& state) { previous_velocity_ = state.velocity; }

 private:
  ImuNoise noise_;
  Eigen::Vector3d gravity_;  ///< in the world's frame, m/s^2
  RandomStream random_;
  Eigen::Vector3d gyro_bias_;
  Eigen::Vector3d accelerometer_bias_;
  Eigen::Vector3d previous_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d summed_rate_ = Eigen::Vector3d::Zero();
  int summed_steps_ = 0;
};

/// Counts ticks on both sides and integrates them with the nominal radius and track,
/// as the rover's firmware does. The true radius and track differ by the scale errors.
class WheelSensor {
 public:
  WheelSensor(const WheelNoise& noise, const maps::RobotModel& robot, std::uint64_t seed);

  /// Turning of the wheels during one physics step, as the encoders see it.
  void advance(double left_rad, double right_rad);
  mrpt::obs::CObservationOdometry::Ptr sample(double interval_s);

 private:
  WheelNoise noise_;
  maps::RobotModel robot_;
  double speed_scale_ = 1.0;
  double turn_scale_ = 1.0;
  double left_rad_ = 0.0;
  double right_rad_ = 0.0;
  long left_ticks_ = 0;
  long right_ticks_ = 0;
  TPose2D odom_from_base_;
};

}  // namespace rovigo::sim
