#pragma once
// Keyframe poses and landmarks together (Triggs et al. 2000): every sighting pulls on both.

#include <vector>

#include "slam/landmark_map.h"
#include "slam/motion_link.h"

namespace rovigo::slam {

struct BundleConfig {
  int iterations = 10;
  bool on_floor = false;           ///< keyframes keep to the plane within tracking's plane sigmas
  std::size_t min_sightings = 2;   ///< landmarks seen less often constrain nothing
  int landmarks_per_view = 150;    ///< enough for a pose; the best seen are taken
  int landmarks_in_views = 40000;  ///< all views together: memory stays bounded on a long drive,
                                   ///< whose views hold each other up and need fewer
  int fewest_per_view = 60;
};

struct BundleResult {
  int sightings = 0;
  int rejected = 0;  ///< sightings that did not fit and were taken out of the map
  double initial_cost = 0.0;
  double final_cost = 0.0;
  bool converged = false;
};

/// Adjusts `keyframes` (those outside the list are held) and the landmarks they see; `links` hold
/// neighbours together, their calibration is solved for as well. Sightings that do not fit in the
/// end are removed. With an empty list all keyframes but the first are adjusted.
BundleResult adjust_bundle(LandmarkMap& map, const std::vector<int>& keyframes,
                           const std::vector<MotionLink>& links, const BundleConfig& config);

}  // namespace rovigo::slam
