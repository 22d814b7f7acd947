#pragma once
// Questions to a grid that precision and recall do not answer.

#include <optional>
#include <vector>

#include "maps/free_space_evaluation.h"
#include "maps/occupancy_grid.h"
#include "sim/world.h"

namespace rovigo::test {

/// Occupied cells of `estimate` amid ground that is free in truth: nothing occupied or unknown
/// within 0.15 m. Only clusters of three or more count: what a person leaves is as large as a leg.
int ghost_cells(const maps::OccupancyGrid& estimate, const maps::OccupancyGrid& truth,
                const TPose2D& truth_from_estimate);

/// Distance between the walls that are met from `middle` (truth's frame) along +x and -x; the
/// median over parallel rays `spread_m` to either side. None when a ray leaves the grid.
std::optional<double> wall_to_wall_m(const maps::OccupancyGrid& grid,
                                     const TPose2D& grid_from_truth, const TPoint2D& middle,
                                     double spread_m);

/// Of the truly occupied cells under the solids of `world` that are part of a low table, the share
/// that `estimate` holds occupied. Like precision and recall within a cell, it bears with a map
/// that is off by a cell: the best of the nine shifts by whole cells, one for all tables. None
/// where the camera saw no low table.
std::optional<double> low_table_share(const maps::OccupancyGrid& estimate,
                                      const maps::OccupancyGrid& truth,
                                      const TPose2D& truth_from_estimate, const sim::World& world);

/// Cells that `estimate` calls free well under a low table's top (a cell and a half from its rim),
/// seen or not: a rover would drive into it.
int low_table_free_cells(const maps::OccupancyGrid& estimate, const TPose2D& truth_from_estimate,
                         const sim::World& world);

}  // namespace rovigo::test
