#pragma once
// Flat scans from stored keyframes, for a camera whose height over the floor nobody has told us.

#include <vector>

#include "slam/depth_scan.h"
#include "slam/landmark_map.h"

namespace rovigo::slam {

struct KeyframeScan {
  TPose2D map_from_level;
  DepthScan scan;
};

/// Height of the floor in the map frame: the lowest level on which surfaces gather. Points
/// scattered below it are noise. With nothing below the camera it is the lowest point seen, so
/// that no ground is called free that was not looked at.
double estimate_floor_height(const std::vector<float>& heights_m);

/// One scan of each keyframe, upright by the map's vertical, above the estimated floor. Keyframes
/// without depth are left out.
std::vector<KeyframeScan> scans_of_keyframes(const LandmarkMap& map, DepthScanner& scanner);

}  // namespace rovigo::slam
