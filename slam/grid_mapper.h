#pragma once
// The occupancy grid from patches of evidence and where they lie (log-odds summed: Moravec & Elfes
// 1985; Thrun, Burgard & Fox, Probabilistic Robotics, chapter 9).

#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/evidence_patch.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

struct PlacedPatch {
  TPose2D map_from_patch;
  const EvidencePatch* patch = nullptr;
};

/// A grid around everything that was seen. A cell is occupied when any of its height bands is, and
/// free when rays crossed all of its upper half: what is open below but hidden above (under a
/// table's top) is unknown, or occupied where it lies amid the top's edges. Cells without
/// evidence are unknown.
maps::OccupancyGrid render_grid(const std::vector<PlacedPatch>& patches, const GridConfig& config);

}  // namespace rovigo::slam
