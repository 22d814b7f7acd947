#pragma once
// Where wheels, gyro and accelerometer carry the rover between looks at the world, and what looks
// teach them.

#include <Eigen/Core>
#include <optional>

#include "maps/geometry.h"
#include "slam/inertial_state.h"
#include "slam/motion_link.h"
#include "slam/planar_information.h"
#include "slam/slam_config.h"
#include "slam/wheel_slip.h"

namespace rovigo::slam {

/// Error-state Kalman filter of a rover on its floor. Every sensor is optional.
/// Model: angular rate constant, acceleration fading; gyro = rate + bias, told late by its delay
/// (against the camera; Li & Mourikis 2014); accelerometer = acceleration + rate x velocity +
/// gravity + bias; the wheels count speed / (1 + speed scale) and, without a gyro, turn rate /
/// (1 + turn scale); the body slips neither sideways nor off the floor. While the wheels stand
/// still velocity and rate are zero, which teaches the biases.
class InertialFilter {
 public:
  explicit InertialFilter(const DeadReckoningConfig& config);

  /// Puts the rover down: pose known to `sigma`s, calibration kept.
  void place(const TPose2D& map_from_base, double sigma_position_m, double sigma_heading_rad);

  /// Angular rate in base_link.
  void add_gyro(double time_s, const Eigen::Vector3d& rate_rad_s);
  /// Specific force in base_link: +9.81 upwards at rest.
  void add_accelerometer(double time_s, const Eigen::Vector3d& specific_force_m_s2);
  /// Pose that the wheels have added up so far, in a frame of their own.
  void add_wheels(double time_s, const TPose2D& odom_from_base);
  /// Carries the pose on to `time_s`; earlier times change nothing.
  void advance_to(double time_s);

  /// Takes a look in. `floor_m`, `floor_rad`: errors that all looks share (the map's own), below
  /// which many looks do not average.
  void correct(const PlanarInformation& look, double floor_m, double floor_rad);

  /// The map moved under the rover (a loop was closed).
  void shift(const TPose2D& new_map_from_old_map);

  TPose2D map_from_base() const { return to_planar(state_.map_from_base); }
  /// Of (x, y, yaw) in the map frame.
  Eigen::Matrix3d pose_covariance() const;
  const InertialState& state() const { return state_; }
  double time_s() const { return time_s_; }
  TTwist2D twist() const;
  bool slipping() const { return slip_.one_side() || slip_.both_sides(); }
  bool standing() const { return standing_; }
  /// Turned by something other than its wheels: somebody has carried it, until it is found again.
  bool carried() const { return carried_; }
  void found() { carried_ = false; }
  MotionCalibration calibration() const;
  /// What the last reading of the wheels added; each step is handed out once.
  std::optional<MotionStep> take_step();

 private:
  void propagate(double dt);
  SlipWitnesses witnesses() const;
  MotionStep step_of(const WheelStep& wheels, double gripped_m, double end_s) const;
  void judge_carrying(const WheelStep& wheels);
  bool looks_standing(const WheelStep& wheels);
  void leave_standing(const WheelStep& wheels);
  void rest();
  void make_up_gyro_delay();
  void measure_wheels(const WheelStep& wheels, double gripped_m);

  DeadReckoningConfig config_;
  InertialState state_;
  WheelSlip slip_;
  double time_s_ = 0.0;
  bool started_ = false;

  std::optional<Eigen::Vector3d> gyro_rate_;
  std::optional<double> gyro_time_s_, accelerometer_time_s_;
  std::optional<TPose2D> odometry_;
  double odometry_time_s_ = 0.0;
  std::optional<double> led_rate_rad_s_;   ///< about the vertical, whose delay is made up for
  std::optional<double> step_rate_rad_s_;  ///< of the gyro, at the last reading of the wheels
  double gyro_turn_rad_ = 0.0;             ///< unbiased, since the last reading of the wheels
  double raw_gyro_turn_rad_ = 0.0;         ///< as read, likewise
  double resting_s_ = 0.0;                 ///< without a tick of the wheels
  std::optional<MotionStep> step_;
  double turned_standing_rad_ = 0.0;  ///< by the gyro while the wheels stood
  bool standing_ = false, carried_ = false;
};

}  // namespace rovigo::slam
