#pragma once
// Where the cells of a grid lie in the world. Written once; every grid and planner uses it.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "maps/geometry.h"

namespace rovigo::maps {

/// Column x (east) and row y (north), counted from the lower-left cell.
struct Cell {
  int x = 0;
  int y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// Larger grids are refused by every loader: distances in cells must fit 16 bits, and a claim of
/// billions of cells in a damaged file must not eat the memory.
inline constexpr int kMaxGridSide = 32766;
inline constexpr std::size_t kMaxGridCells = std::size_t{1} << 28;

/// An axis-aligned raster: `width` x `height` square cells, row-major from the lower-left corner.
struct GridGeometry {
  double resolution_m = 0.05;
  TPoint2D origin{0.0, 0.0};  ///< lower-left corner of cell (0, 0), metres
  int width = 0;
  int height = 0;

  std::size_t size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  bool contains(Cell c) const { return c.x >= 0 && c.y >= 0 && c.x < width && c.y < height; }
  bool contains(const TPoint2D& p) const { return contains(cell_at(p)); }

  /// The cell a point falls into; outside the grid for points outside it (never throws).
  Cell cell_at(const TPoint2D& p) const {
    return {floor_to_int((p.x - origin.x) / resolution_m),
            floor_to_int((p.y - origin.y) / resolution_m)};
  }
  TPoint2D center_of(Cell c) const {
    return {origin.x + (c.x + 0.5) * resolution_m, origin.y + (c.y + 0.5) * resolution_m};
  }
  std::size_t index_of(Cell c) const {
    return static_cast<std::size_t>(c.y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(c.x);
  }
  Cell cell_of(std::size_t index) const {
    const auto w = static_cast<std::size_t>(width);
    return {static_cast<int>(index % w), static_cast<int>(index / w)};
  }
  friend bool operator==(const GridGeometry& a, const GridGeometry& b) {
    return a.resolution_m == b.resolution_m && a.origin.x == b.origin.x &&
           a.origin.y == b.origin.y && a.width == b.width && a.height == b.height;
  }

 private:
  /// floor() that saturates, so that huge or non-finite points stay outside instead of wrapping.
  static int floor_to_int(double v) {
    constexpr double kLimit = 1.0e9;
    if (!(v > -kLimit)) return -1;  // also catches NaN
    if (v > kLimit) return static_cast<int>(kLimit);
    return static_cast<int>(std::floor(v));
  }
};

}  // namespace rovigo::maps
