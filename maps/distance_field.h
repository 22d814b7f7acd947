#pragma once
// Exact Euclidean distance to the nearest obstacle, at cell centres and anywhere between them.

#include <vector>

#include "maps/costmap.h"
#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// For every cell, metres from its centre to the edge of the nearest obstacle cell: 0 inside one,
/// infinity where the grid has none. Row-major as the grid.
struct DistanceField {
  GridGeometry geometry;
  std::vector<float> meters;
  float at(Cell c) const { return meters[geometry.index_of(c)]; }
};

/// Obstacles are the occupied cells. Linear time (Meijster et al. 2000, with the metric's half-cell
/// offset so that distances reach to cell edges).
DistanceField distance_to_occupied(const OccupancyGrid& grid);

/// The same where the obstacles are the cells that these points lie in; points outside do not
/// count.
DistanceField distance_to_points(const GridGeometry& geometry, const std::vector<TPoint2D>& points);

/// Metres from `point` (anywhere, also between centres) to the edge of the nearest occupied cell,
/// exact; at most `limit_m` is looked at and returned. Outside the grid there is nothing.
double clearance_at(const OccupancyGrid& grid, const DistanceField& field, const TPoint2D& point,
                    double limit_m);

}  // namespace rovigo::maps
