#pragma once
// The rover's rectangle against the grid, for the checker; shares no code with footprint.h.

#include "maps/occupancy_grid.h"

namespace rovigo::planning {

struct FootprintSize {
  double length_m = 0.0;
  double width_m = 0.0;
};

/// Metres from the rectangle, centred on the pose, to the nearest occupied cell, looked at up to
/// `limit_m`; 0 where they overlap.
double footprint_clearance(const maps::OccupancyGrid& grid, const TPose2D& pose,
                           const FootprintSize& size, double limit_m);

}  // namespace rovigo::planning
