#pragma once
// slam's own map to and from the map file's keyframes.

#include <vector>

#include "maps/map_file.h"
#include "slam/landmark_map.h"
#include "slam/pose_graph.h"

namespace rovigo::slam {

/// Keyframes with their living landmarks, as a map file holds them. Their images are moved out of
/// the map: they are the greatest part of it.
std::vector<maps::StoredKeyframe> hand_over_keyframes(LandmarkMap& map);

/// The graph's edges in the map file's order of coordinates.
std::vector<maps::StoredEdge> store_edges(const std::vector<PoseGraphEdge>& edges);

/// The map a saved file's keyframes describe. Throws InputError for features that cannot be read
/// or a pose that is not finite.
LandmarkMap restore_landmark_map(const maps::SavedMap& saved, const SlamConfig& config);

}  // namespace rovigo::slam
