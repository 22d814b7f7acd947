#include "slam/pose_report.h"

#include <cmath>

namespace rovigo::slam {

PoseEstimate report_pose(const Se3& map_from_base, double time_s, const MotionPrediction& now,
                         const Keyframe* reference, TrackingState state, double frame_age_s,
                         const LocalizerConfig& config) {
  PoseEstimate e;
  e.time_s = time_s;
  e.map_from_base = to_mrpt(map_from_base);
  e.sigma_position_m = now.sigma_position_m;
  e.sigma_heading_rad = now.sigma_heading_rad;
  if (reference != nullptr) {
    // The filter knows the pose against the keyframe in view; that one is not known exactly either.
    e.sigma_position_m = std::hypot(e.sigma_position_m, reference->sigma_m);
    e.sigma_heading_rad = std::hypot(e.sigma_heading_rad, reference->sigma_rad);
  }
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
