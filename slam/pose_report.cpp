#include "slam/pose_report.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

PoseEstimate report_pose(const Se3& map_from_base, double time_s, const MotionPrediction& now,
                         const Eigen::Matrix3d& map_covariance, TrackingState state,
                         double frame_age_s, const LocalizerConfig& config) {
  PoseEstimate e;
  e.time_s = time_s;
  e.map_from_base = to_mrpt(map_from_base);
  // The filter knows the pose against the map in view; that is not known exactly either.
  const Eigen::Matrix3d covariance = now.covariance + map_covariance;
  e.sigma_position_m = std::sqrt(std::max(0.0, covariance(0, 0) + covariance(1, 1)));
  e.sigma_heading_rad = std::sqrt(std::max(0.0, covariance(2, 2)));
  if (state == TrackingState::kLost) return e;
  if (state == TrackingState::kTracking && frame_age_s < kFrameIsLateS) {
    e.health = Health::kOk;
    e.confidence = 0.95;
  } else if (now.sigma_position_m < config.lost_sigma_m) {
    e.health = Health::kDegraded;
    e.confidence = 0.6;
  }
  return e;
}

}  // namespace rovigo::slam
