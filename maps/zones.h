#pragma once
// No-go zones drawn into the grid that planners search.

#include <vector>

#include "maps/map_file.h"
#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// Makes every cell that a zone touches, inside or on its outline, occupied. Do this to the grid
/// before inflating it or asking it for distances: zones then keep robot_radius_m away like walls
/// do, whatever the map mode. The outline closes itself; one or two corners make a point or a line;
/// where outlines cross, a place is inside when it is enclosed an odd number of times.
/// Throws InputError for corners that are not finite.
void apply_zones(OccupancyGrid& grid, const std::vector<NoGoZone>& zones);

/// A grid of its own with the zones occupied and everything else free (ROS keep-out mask).
OccupancyGrid keepout_mask(const GridGeometry& geometry, const std::vector<NoGoZone>& zones);

}  // namespace rovigo::maps
