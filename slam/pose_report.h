#pragma once
// The pose believed, with what may be said about how far to trust it.

#include "slam/motion_model.h"
#include "slam/pose_estimate.h"
#include "slam/tracking_health.h"

namespace rovigo::slam {

/// `map_covariance`: of the map at this pose (x, y, yaw), against its first keyframe.
/// `frame_age_s`: since the last camera frame; without one for long, nothing can be called tracked.
PoseEstimate report_pose(const Se3& map_from_base, double time_s, const MotionPrediction& now,
                         const Eigen::Matrix3d& map_covariance, TrackingState state,
                         double frame_age_s, const LocalizerConfig& config);

/// A camera that is silent for so long leaves the rover to dead reckoning.
inline constexpr double kFrameIsLateS = 0.3;

}  // namespace rovigo::slam
