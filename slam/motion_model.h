#pragma once
// What is believed about the rover's pose before the camera looks: wheels and IMU on the floor,
// or constant velocity for a camera in free motion.

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include "slam/inertial_filter.h"
#include "slam/pose_optimizer.h"
#include "slam/rig.h"

namespace rovigo::slam {

struct MotionPrediction {
  PosePrior6 prior;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw), map frame
  double sigma_position_m = 0.0;                         ///< of both axes together
  double sigma_heading_rad = 0.0;
  /// In base_link; turning smears and shears images.
  Eigen::Vector3d turn_rate_rad_s = Eigen::Vector3d::Zero();
};

class MotionModel {
 public:
  MotionModel(const SlamConfig& config, const Rig& rig);

  /// True when the rover is known to stay on the floor (wheels, and the camera's place on it).
  bool planar() const { return planar_; }

  void add(const mrpt::obs::CObservationIMU& imu);
  void add(const mrpt::obs::CObservationOdometry& wheels);

  MotionPrediction predict(double time_s);
  /// Takes in what vision found at `time_s`; returns the pose believed from then on.
  Se3 correct(double time_s, const PoseSolution& solution);
  /// Takes in what walls say of a rover on its floor, now.
  Se3 correct(const PlanarInformation& look);
  /// Vision found nothing: motion without a look becomes less certain.
  void miss(double time_s);
  /// Puts the rover at a pose found otherwise (start, relocalisation).
  void place(double time_s, const Se3& map_from_base, double sigma_position_m,
             double sigma_heading_rad);
  void shift(const Se3& new_map_from_old_map);

  const InertialFilter& dead_reckoning() const { return planar_filter_; }
  /// The body turned while its wheels stood, and no look has confirmed a pose since.
  bool carried() const { return planar_ && planar_filter_.carried(); }

  /// A keyframe was made: wheels and gyro tie it to the one before, unless `cut` was called since.
  void mark_keyframe(int keyframe, double time_s);
  void cut_link() { links_.cut(); }
  const std::vector<MotionLink>& links() const { return links_.links(); }
  std::vector<MotionLink>& links() { return links_.links(); }

 private:
  Se3 predict_free(double time_s) const;

  TrackingConfig tracking_;
  bool planar_ = false;
  InertialFilter planar_filter_;
  MotionLinks links_;

  // Free motion.
  Se3 map_from_base_;
  double time_s_ = 0.0;
  bool has_pose_ = false;
  Vector6d twist_ = Vector6d::Zero();  ///< in the base frame
  double unseen_s_ = 0.0;
  Eigen::Matrix3d gyro_turn_ = Eigen::Matrix3d::Identity();  ///< since the last look
  double gyro_time_s_ = 0.0;
  bool has_gyro_ = false;
};

/// What a solution says about x, y and yaw when height and tilt are only known to `sigmas`.
PlanarInformation planar_information(const PoseSolution& solution, const TrackingConfig& config);

}  // namespace rovigo::slam
