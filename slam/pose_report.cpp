#include "slam/pose_report.h"

#include <algorithm>
#include <cmath>

#include "slam/localizer_evidence.h"

namespace rovigo::slam {

namespace {

// Of the confidence where nothing is seen: somebody may have carried the rover.
constexpr double kBlindShare = 0.9;

}  // namespace

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
  e.confidence = chance_within_limits(now.sigma_position_m, now.sigma_heading_rad);
  if (state == TrackingState::kTracking && frame_age_s < kFrameIsLateS) {
    e.health = Health::kOk;
  } else if (now.sigma_position_m < config.lost_sigma_m) {
    e.health = Health::kDegraded;
    e.confidence *= kBlindShare;
  } else {
    e.confidence = 0.0;
  }
  return e;
}

}  // namespace rovigo::slam
