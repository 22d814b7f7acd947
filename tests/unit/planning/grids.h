#pragma once
// Small worlds drawn as text, for the planning tests.

#include <string>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::planning {

/// Rows from top to bottom: '#' occupied, '?' unknown, anything else free. Lower-left corner at the
/// origin.
inline maps::OccupancyGrid grid_of(const std::vector<std::string>& rows, double resolution_m) {
  maps::GridGeometry g;
  g.resolution_m = resolution_m;
  g.width = static_cast<int>(rows.front().size());
  g.height = static_cast<int>(rows.size());
  maps::OccupancyGrid grid(g, maps::OccupancyGrid::kFree);
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      const char c = rows[static_cast<std::size_t>(g.height - 1 - y)][static_cast<std::size_t>(x)];
      if (c == '#') grid.at({x, y}) = maps::OccupancyGrid::kOccupied;
      if (c == '?') grid.at({x, y}) = maps::OccupancyGrid::kUnknown;
    }
  }
  return grid;
}

/// A free room of the given size in metres, walls one cell thick around it.
inline maps::OccupancyGrid room(double width_m, double height_m, double resolution_m = 0.05) {
  maps::GridGeometry g;
  g.resolution_m = resolution_m;
  g.width = static_cast<int>(width_m / resolution_m + 0.5);
  g.height = static_cast<int>(height_m / resolution_m + 0.5);
  maps::OccupancyGrid grid(g, maps::OccupancyGrid::kFree);
  for (int x = 0; x < g.width; ++x) {
    grid.at({x, 0}) = grid.at({x, g.height - 1}) = maps::OccupancyGrid::kOccupied;
  }
  for (int y = 0; y < g.height; ++y) {
    grid.at({0, y}) = grid.at({g.width - 1, y}) = maps::OccupancyGrid::kOccupied;
  }
  return grid;
}

/// Fills the cells whose centres lie in the rectangle.
inline void fill(maps::OccupancyGrid& grid, double x0, double y0, double x1, double y1,
                 std::int8_t value = maps::OccupancyGrid::kOccupied) {
  for (int y = 0; y < grid.geometry.height; ++y) {
    for (int x = 0; x < grid.geometry.width; ++x) {
      const TPoint2D c = grid.geometry.center_of({x, y});
      if (c.x >= x0 && c.x <= x1 && c.y >= y0 && c.y <= y1) grid.at({x, y}) = value;
    }
  }
}

}  // namespace rovigo::planning
