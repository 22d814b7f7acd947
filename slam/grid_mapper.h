#pragma once
// The occupancy grid from flat depth scans and the poses they were taken at (log-odds: Moravec &
// Elfes 1985; Thrun, Burgard & Fox, Probabilistic Robotics, chapter 9).

#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/depth_scan.h"

namespace rovigo::slam {

struct PlacedScan {
  TPose2D map_from_level;
  const DepthScan* scan = nullptr;
};

struct GridRequest {
  std::vector<PlacedScan> scans;
  std::vector<TPose2D> driven;  ///< where the rover's own body has been: free for certain
  double driven_radius_m = 0.0;
};

/// A grid around everything that was seen. Cells without evidence are unknown. A hit outweighs the
/// rays of its own scan that pass over the cell. Rays clear every cell they cross below obstacle
/// height, whatever they end on.
maps::OccupancyGrid render_grid(const GridRequest& request, const GridConfig& config);

}  // namespace rovigo::slam
