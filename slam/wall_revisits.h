#pragma once
// Rooms driven through again, the other way round: no corner is seen as it was seen before, but
// walls are the same from wherever they are looked at. They close loops that appearance leaves
// open.

#include <vector>

#include "slam/landmark_map.h"
#include "slam/motion_link.h"

namespace rovigo::slam {

/// Ties between keyframes long apart by the walls they see in common. The poses must be right to a
/// decimetre or so; matches that ask for more are left out.
std::vector<MotionLink> wall_revisits(const LandmarkMap& map);

}  // namespace rovigo::slam
