#pragma once
// A place that features suggested, judged by the depth image instead.

#include <vector>

#include "slam/camera_frame.h"
#include "slam/grid_match.h"
#include "slam/landmark_map.h"

namespace rovigo::slam {

/// The map's landmarks against the depth image, at a pose: what should be in view, is it there?
/// Features are not asked, so this judges a place that they suggested.
struct DepthAgreement {
  int at_depth = 0;      ///< the camera measures about the landmark's distance
  int seen_through = 0;  ///< it sees farther: the landmark is not there
  int hidden = 0;        ///< something nearer stands before it
  /// What is hidden says little, but where most is hidden this is another place.
  int judged() const { return at_depth + seen_through + hidden / 3; }
  /// Share of the judged landmarks that are there; 1 where there is nothing to judge.
  double share() const { return judged() > 0 ? static_cast<double>(at_depth) / judged() : 1.0; }
};

/// `landmarks`: those to ask about; the ones outside the view are passed over, and so are, in a map
/// whose floor is known (`on_floor`), those on the floor or at the ceiling. With `walls` (null: not
/// known) a landmark that the map itself has behind a wall is not expected to be seen.
DepthAgreement depth_agreement(const LandmarkMap& map, const std::vector<int>& landmarks,
                               const CameraFrame& frame, const Se3& map_from_base, bool on_floor,
                               const SignedDistanceField* walls = nullptr);

}  // namespace rovigo::slam
