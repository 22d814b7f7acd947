#pragma once
// Stored keyframes brought upright, for a camera whose height over the floor nobody has told us.

#include <vector>

#include "slam/landmark_map.h"

namespace rovigo::slam {

/// Where the camera of a keyframe was, above the floor below it.
struct LevelView {
  int keyframe = 0;
  Se3 level_from_camera;
};

/// Height of the floor in the map frame: the lowest level on which surfaces gather. Points
/// scattered below it are noise. With nothing below the camera it is the lowest point seen, so
/// that no ground is called free that was not looked at.
double estimate_floor_height(const std::vector<float>& heights_m);

/// The keyframes that have depth, upright by the map's vertical, above the estimated floor.
std::vector<LevelView> level_views(const LandmarkMap& map);

}  // namespace rovigo::slam
