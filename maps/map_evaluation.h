#pragma once
// How good a map is, measured against the true one.

#include <cstddef>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// Shares are 0 where there was nothing to judge (see the counts).
struct MapScores {
  double precision = 0.0;  ///< of the judged occupied cells, the share near a truly occupied one
  double recall = 0.0;     ///< of the truly occupied cells, the share near an estimated one
  double free_iou = 0.0;   ///< of the cells known in truth: both free / either free
  double tolerance_m = 0.0;
  std::size_t judged_occupied_cells = 0;   ///< estimated occupied, not in unknown truth
  std::size_t skipped_occupied_cells = 0;  ///< estimated occupied where the truth knows nothing
  std::size_t true_occupied_cells = 0;
  std::size_t known_true_cells = 0;
};

/// Compares two grids that may differ in origin, size, resolution and heading. A cell is looked up
/// by its centre; "near" means that the centres of the cells concerned are at most
/// `tolerance_cells` of the truth's cells apart. What the truth calls unknown is not judged: an
/// estimated obstacle there counts only when a true one is near.
MapScores evaluate_map(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                       const TPose2D& truth_from_estimate, double tolerance_cells);

}  // namespace rovigo::maps
