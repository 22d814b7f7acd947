#pragma once
// How wheels and gyro say two keyframes lie, and how that changes with their calibration
// (preintegration on the plane: Lupton & Sukkarieh 2012; Forster et al. 2017).

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "maps/geometry.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

/// What wheels and gyro said between two readings of the wheels, uncalibrated.
struct MotionStep {
  double begin_s = 0.0, end_s = 0.0;
  double distance_m = 0.0;              ///< of the wheel that grips
  double turn_rad = 0.0;                ///< of the gyro, or of the wheels where there is no gyro
  double turn_rate_change_rad_s = 0.0;  ///< of the gyro, from begin to end
  bool has_gyro = false;
  bool slipping = false;
  double unseen_speed_m_s = 0.0;  ///< WheelSlip::unseen_speed_m_s()
  bool standing = false;
};

/// Variances that a step adds: along and across the heading, and of the heading.
struct StepNoise {
  double along_m2 = 0.0, across_m2 = 0.0, heading_rad2 = 0.0;
};
StepNoise noise_of(const MotionStep& step, const DeadReckoningConfig& config);

/// Gyro bias (rad/s), error of the wheels' speed scale, of their turn scale (shares), how late the
/// gyro tells of a turn (s).
using MotionCalibration = Eigen::Vector4d;
using ByCalibration = Eigen::Matrix<double, 3, 4>;

struct MotionLink {
  int from = -1, to = -1;  ///< keyframes
  double begin_s = 0.0, end_s = 0.0;
  TPose2D from_from_to;  ///< under `calibration`
  MotionCalibration calibration = MotionCalibration::Zero();
  ByCalibration by_calibration = ByCalibration::Zero();  ///< of (x, y, yaw), first order
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< with the calibration known

  /// The same motion under another calibration.
  TPose2D under(const MotionCalibration& other) const;
};

/// Adds steps up from keyframe to keyframe.
class MotionLinks {
 public:
  explicit MotionLinks(const DeadReckoningConfig& config) : config_(config) {}

  void add(const MotionStep& step);
  /// A keyframe was made at `time_s`, with the calibration believed then. Its link is whole once
  /// the step that covers the moment has been added.
  void mark(int keyframe, double time_s, const MotionCalibration& calibration);
  /// The rover was carried: what comes is not tied to what was.
  void cut();

  const std::vector<MotionLink>& links() const { return links_; }
  std::vector<MotionLink>& links() { return links_; }

 private:
  struct Mark {
    int keyframe = -1;
    double time_s = 0.0;
    MotionCalibration calibration = MotionCalibration::Zero();
  };
  void integrate(const MotionStep& step);
  void finish(const Mark& mark);

  DeadReckoningConfig config_;
  std::deque<Mark> marks_;  ///< whose moment has not been reached
  MotionLink open_;
  std::vector<MotionLink> links_;
  double reached_s_ = 0.0;
};

}  // namespace rovigo::slam
