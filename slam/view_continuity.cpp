#include "slam/view_continuity.h"

namespace rovigo::slam {

namespace {

constexpr double kLongestGapS = 0.4;  // at walking pace the view still overlaps
constexpr int kEnoughPoints = 150;    // of about 700 in a full image
constexpr double kGoingOn = 0.75;     // share of them; people walk through, edges flicker

}  // namespace

bool ViewContinuity::follows(const CameraFrame& frame, const Se3& map_from_base) {
  const DepthSample sample = sample_depth(frame.depth, frame.depth_unit_m);
  const Se3 map_from_camera = map_from_base * base_from_camera_;
  bool follows = false;
  if (last_ && frame.time_s - last_->time_s <= kLongestGapS) {
    const DepthAgreement seen =
        compare(last_->points, map_from_camera.inverse() * last_->map_from_camera, sample, camera_);
    const int judged = seen.at_depth + seen.seen_through + seen.hidden;
    follows = judged >= kEnoughPoints && seen.at_depth >= kGoingOn * judged;
  }
  last_ = Last{frame.time_s, map_from_camera, lift(sample, camera_)};
  return follows;
}

}  // namespace rovigo::slam
