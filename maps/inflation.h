#pragma once
// Obstacles grown by the rover's size: the costmap that planners search.

#include "maps/costmap.h"
#include "maps/occupancy_grid.h"
#include "maps/settings.h"

namespace rovigo::maps {

struct InflationConfig {
  double robot_radius_m = 0.30;  ///< nearer than this to an occupied cell's edge is lethal
  double soft_cost_sigma_m =
      0.04;                  ///< of the Gaussian of the distance beyond robot_radius_m; 0: none
  int soft_cost_peak = 200;  ///< soft cost right at robot_radius_m, 0 .. Costmap::kMaxSoft
  MapMode map_mode = MapMode::kKnownFree;

  /// All but robot_radius_m, which is the robot's (RobotModel). `map_mode` is the number 0, 1 or 2.
  void describe(SettingsVisitor& v);
};

/// Safe mode. A cell is lethal when its centre is nearer than `robot_radius_m` to the edge of an
/// occupied cell (exact Euclidean distance); beyond it costs fall off as a Gaussian of the
/// distance. Unknown cells are kUnknown (impassable) in map mode 0 unless they are lethal, and cost
/// what known ones do in mode 1; in mode 2 everything is free.
/// Throws InputError for a radius, sigma or peak that is negative, not finite or too large.
Costmap inflate_safe(const OccupancyGrid& grid, const InflationConfig& config);

/// Reference mode (mission R6): SciPy's gaussian_filter of the integer 0/100 grid, cut down to
/// integers after each axis pass; every non-zero cell is lethal, all others free. What is blurred
/// follows the source, too: in map mode 0 every cell that is not 0 (unknown ones included), in mode
/// 1 every cell above 0; in mode 2 everything is free. `sigma_cells` 0 switches the blur off.
/// Known for what it is: lone cells fade away at sigma 4 and above.
/// Throws InputError for a sigma outside [0, 100].
Costmap inflate_reference(const OccupancyGrid& grid, double sigma_cells, MapMode map_mode);

/// Columns and rows of a part of a grid, `upper` not included.
struct CellRect {
  Cell lower;
  Cell upper;
};

/// After cells within `changed` (and no others) were changed in `grid`: brings the costmap that was
/// made of it before up to date. The result has the same bytes as inflating anew; the time is that
/// of the rectangle and what it reaches. Throws as inflating does, and for a costmap of another
/// size.
void update_safe(const OccupancyGrid& grid, const CellRect& changed, const InflationConfig& config,
                 Costmap& costmap);
void update_reference(const OccupancyGrid& grid, const CellRect& changed, double sigma_cells,
                      MapMode map_mode, Costmap& costmap);

}  // namespace rovigo::maps
