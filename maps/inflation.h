#pragma once
// Obstacles grown by the rover's size: the costmap that planners search.

#include "maps/costmap.h"
#include "maps/occupancy_grid.h"
#include "maps/settings.h"

namespace rovigo::maps {

struct InflationConfig {
  double robot_radius_m = 0.30;  ///< nearer than this to an occupied cell's edge is lethal
  double soft_cost_sigma_m =
      0.15;                  ///< of the Gaussian of the distance beyond robot_radius_m; 0: none
  int soft_cost_peak = 200;  ///< soft cost right at robot_radius_m, 0 .. Costmap::kMaxSoft
  MapMode map_mode = MapMode::kKnownFree;
};

/// Safe mode. A cell is lethal when its centre is nearer than `robot_radius_m` to the edge of an
/// occupied cell (exact Euclidean distance); beyond it costs fall off as a Gaussian of the
/// distance.
Costmap inflate_safe(const OccupancyGrid& grid, const InflationConfig& config);

/// Reference mode (mission R6): SciPy's gaussian_filter of the integer 0/100 grid, truncated to
/// integers after each axis pass; every non-zero cell is lethal. `sigma_cells` 0 switches it off.
Costmap inflate_reference(const OccupancyGrid& grid, double sigma_cells, MapMode map_mode);

}  // namespace rovigo::maps
