#pragma once
// The occupancy grid, with the meaning ROS gives it.

#include <cstdint>
#include <vector>

#include "maps/grid_geometry.h"

namespace rovigo::maps {

/// Probability that a cell is occupied: 0 free .. 100 occupied, -1 unknown.
/// Row-major from the lower-left corner.
struct OccupancyGrid {
  static constexpr std::int8_t kFree = 0;
  static constexpr std::int8_t kOccupied = 100;
  static constexpr std::int8_t kUnknown = -1;
  /// At or above this a cell counts as an obstacle (ROS map_server's occupied_thresh, 0.65).
  static constexpr std::int8_t kOccupiedThreshold = 65;

  GridGeometry geometry;
  std::vector<std::int8_t> cells;

  OccupancyGrid() = default;
  explicit OccupancyGrid(const GridGeometry& g, std::int8_t value = kUnknown)
      : geometry(g), cells(g.size(), value) {}

  std::int8_t& at(Cell c) { return cells[geometry.index_of(c)]; }
  std::int8_t at(Cell c) const { return cells[geometry.index_of(c)]; }
  static bool is_occupied(std::int8_t value) { return value >= kOccupiedThreshold; }
  static bool is_unknown(std::int8_t value) { return value < 0; }
  static bool is_free(std::int8_t value) { return value >= 0 && value < kOccupiedThreshold; }
};

}  // namespace rovigo::maps
