#pragma once
// The linear-time distance transform under the distance field and the inflation.

#include <cstdint>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// Squared distances from cell centres to the edges of the nearest occupied cell, exact, in units
/// of half a cell: an obstacle k columns away is 2k - 1 half cells off. Meijster, Roerdink &
/// Hesselink 2000 with that metric; the first phase is done on construction, the second row by row.
class SquaredDistanceTransform {
 public:
  static constexpr std::int64_t kNone = INT64_MAX;

  /// Obstacles further than `limit_half_cells` are not looked at, which makes open space cheap.
  /// Throws InputError for a grid with a side above kMaxGridSide.
  SquaredDistanceTransform(const OccupancyGrid& grid, double limit_half_cells);

  /// The distances of row `y`, kNone where no obstacle lies within the limit (values above its
  /// square may appear, too). Valid until the next call.
  const std::vector<std::int64_t>& row(int y);

 private:
  struct Site {
    int column;
    int first;           ///< from this column on it is the nearest one
    std::int64_t along;  ///< squared distance within the column
  };

  void build_envelope(int y);

  int width_;
  int limit_cells_;                   ///< vertical distance beyond which a column does not count
  std::vector<std::int16_t> column_;  ///< cells to the nearest obstacle in the same column
  std::vector<Site> envelope_;
  std::vector<std::int64_t> row_;
};

}  // namespace rovigo::maps
