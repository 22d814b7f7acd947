#pragma once
// What the depth image says of the pose believed, where features say nothing.

#include <vector>

#include "slam/camera_frame.h"
#include "slam/landmark_map.h"
#include "slam/tracking_health.h"

namespace rovigo::slam {

/// The landmarks that should be in view against the depth image; features need not be asked.
ViewVerdict view_verdict(const LandmarkMap& map, const std::vector<int>& landmarks,
                         const CameraFrame& frame, const Se3& map_from_base, bool on_floor);

}  // namespace rovigo::slam
