#pragma once
// Out of the band around obstacles, for a rover that finds itself inside it.

#include <optional>
#include <vector>

#include "planning/free_space.h"

namespace rovigo::planning {

/// A polyline from `start`, which is not free, to a free point: the nearest that a straight segment
/// reaches without getting nearer to an obstacle than the start is; failing that, a way over cells
/// that gets at most one cell nearer. Never touches an occupied cell. nullopt: there is none
/// within `max_distance_m`, or the start touches an occupied cell.
std::optional<std::vector<TPoint2D>> find_escape(const maps::OccupancyGrid& grid,
                                                 const FreeSpace& space, const TPoint2D& start,
                                                 double max_distance_m);

/// The free point nearest to `point` on the way from it to its cell's centre; nullopt when the
/// centre is not free. A point in a passable cell can be nearer to an obstacle than the centre.
std::optional<TPoint2D> free_point_in_cell(const FreeSpace& space, const TPoint2D& point);

}  // namespace rovigo::planning
