#pragma once
// Which part of the map a frame is compared with, and when a frame becomes part of the map.

#include <vector>

#include "slam/landmark_map.h"
#include "slam/tracker.h"

namespace rovigo::slam {

struct LocalMap {
  int reference_keyframe = -1;  ///< shares the most with the last tracked frame
  std::vector<int> keyframes;
  std::vector<int> landmarks;
};

/// The keyframes that see what was tracked last, and their closest relatives; where nothing was
/// tracked, the keyframes nearest to `map_from_base` that look the same way.
LocalMap select_local_map(const LandmarkMap& map, const std::vector<int>& tracked_landmarks,
                          const Se3& map_from_base);

/// How far one pose is from another, in units of the keyframe spacing (1: time for a new one).
double keyframe_spacing(const Se3& a, const Se3& b, const TrackingConfig& config);

/// True when the frame shows enough that no keyframe shows yet.
bool wants_keyframe(const LandmarkMap& map, const LocalMap& local, const TrackResult& result,
                    const FeatureSet& features, const Se3& map_from_base);

}  // namespace rovigo::slam
