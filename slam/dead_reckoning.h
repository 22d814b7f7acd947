#pragma once
// Where wheels and gyro carry the rover between looks at the world, and what looks teach them.

#include <Eigen/Core>
#include <optional>

#include "maps/geometry.h"
#include "slam/motion_link.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

/// A look at the world, as a quadratic cost on the planar pose (x, y, yaw in the map frame):
/// cost(d) = gradient' d + d' information d / 2 around `map_from_base`. The information may be
/// singular: a direction that vision does not constrain is left alone.
struct PlanarInformation {
  TPose2D map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// Extended Kalman filter of a rover on a plane.
/// State: x, y, yaw, gyro bias, wheel-speed scale error, wheel-turn scale error, where
/// speed = (1 + k_speed) * wheels and turn rate = gyro - bias, or (1 + k_turn) * wheels without a
/// gyro. While the wheels stand still the gyro reads its bias. Where wheels and gyro disagree on
/// the turn rate a wheel slips: the speed then follows the wheel that grips.
class DeadReckoning {
 public:
  static constexpr int kSize = 6;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  enum Index { kX, kY, kYaw, kGyroBias, kSpeedScale, kTurnScale };

  explicit DeadReckoning(const DeadReckoningConfig& config);

  /// Puts the rover down: pose known to `sigma`s, calibration kept.
  void place(const TPose2D& map_from_base, double sigma_position_m, double sigma_heading_rad);

  /// Turn rate about z of base_link.
  void add_gyro(double time_s, double yaw_rate_rad_s);
  /// Pose that the wheels have added up so far, in a frame of their own.
  void add_wheels(double time_s, const TPose2D& odom_from_base);
  /// Carries the pose on to `time_s`; earlier times change nothing.
  void advance_to(double time_s);

  /// Takes a look in. `floor_m`, `floor_rad`: errors that all looks share (the map's own), below
  /// which many looks do not average.
  void correct(const PlanarInformation& look, double floor_m, double floor_rad);

  /// The map moved under the rover (a loop was closed).
  void shift(const TPose2D& new_map_from_old_map);

  TPose2D map_from_base() const { return {x_(kX), x_(kY), x_(kYaw)}; }
  Eigen::Matrix3d pose_covariance() const { return p_.topLeftCorner<3, 3>(); }
  const Vector& state() const { return x_; }
  const Matrix& covariance() const { return p_; }
  double time_s() const { return time_s_; }
  TTwist2D twist() const;
  bool slipping() const { return slipping_; }
  bool standing() const { return standing_; }
  /// Turned by something other than its wheels: somebody has carried it, until it is found again.
  bool carried() const { return carried_; }
  void found() { carried_ = false; }
  MotionCalibration calibration() const { return x_.tail<3>(); }
  /// What the last reading of the wheels added; each step is handed out once.
  std::optional<MotionStep> take_step();

 private:
  void propagate(double dt);
  void move_along_heading(double distance_m);
  void update_scalar(const Vector& h, double innovation, double variance);
  void judge_slip(double wheel_turn_rate, double dt);
  void judge_carrying(double wheel_distance_m, double wheel_turn_rad);
  double turn_rate() const;

  DeadReckoningConfig config_;
  Vector x_ = Vector::Zero();
  Matrix p_ = Matrix::Zero();
  double time_s_ = 0.0;
  bool started_ = false;

  std::optional<double> gyro_rate_, gyro_time_s_;
  std::optional<TPose2D> odometry_;
  double odometry_time_s_ = 0.0;
  double wheel_speed_ = 0.0;                                  ///< raw, of the last interval
  double wheel_turn_rate_ = 0.0;                              ///< raw, of the last interval
  double assumed_distance_m_ = 0.0, assumed_turn_rad_ = 0.0;  ///< raw, since the last reading
  double gyro_turn_rad_ = 0.0;       ///< unbiased, since the last reading of the wheels
  double disagreement_rad_s_ = 0.0;  ///< wheels minus gyro, smoothed
  double raw_gyro_turn_rad_ = 0.0;   ///< as read, likewise
  std::optional<MotionStep> step_;
  double turned_standing_rad_ = 0.0;  ///< by the gyro while the wheels stood
  bool slipping_ = false, standing_ = false, carried_ = false;
};

}  // namespace rovigo::slam
