#pragma once
// When a frame becomes a keyframe of the map, and what is kept of it.

#include <vector>

#include "slam/local_map.h"
#include "slam/tracking_health.h"

namespace rovigo::slam {

/// Tracked frames join where they show something new. A rover that sees nothing it knows still
/// knows where it is: its frames join by dead reckoning, so that the map goes on behind a plain
/// corridor, and a plain corridor itself becomes a chain of waypoints that the back end can bend.
bool frame_joins_map(const LandmarkMap& map, const LocalMap& local, const TrackResult& result,
                     const FeatureSet& features, const Se3& map_from_base,
                     const TrackingHealth& health, bool on_floor);

/// A frame as the map keeps it; `matches` say which landmarks its features are.
Keyframe make_keyframe(const CameraFrame& frame, FeatureSet features,
                       const std::vector<FeatureMatch>& matches, const Se3& map_from_base);

}  // namespace rovigo::slam
