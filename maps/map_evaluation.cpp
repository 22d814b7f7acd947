#include "maps/map_evaluation.h"

#include <cmath>
#include <vector>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

/// Is there an occupied cell of `grid` near a point?
class NearbyObstacle {
 public:
  NearbyObstacle(const OccupancyGrid& grid, double tolerance_m) : grid_(grid) {
    const double radius = tolerance_m / grid.geometry.resolution_m + 1e-9;
    const int reach = static_cast<int>(radius);
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (std::hypot(dx, dy) <= radius) disc_.push_back({dx, dy});
      }
    }
  }
  bool at(const TPoint2D& point) const {
    const Cell c = grid_.geometry.cell_at(point);
    for (const Cell& d : disc_) {
      const Cell n{c.x + d.x, c.y + d.y};
      if (grid_.geometry.contains(n) && OccupancyGrid::is_occupied(grid_.at(n))) return true;
    }
    return false;
  }

 private:
  const OccupancyGrid& grid_;
  std::vector<Cell> disc_;
};

std::int8_t value_at(const OccupancyGrid& grid, const TPoint2D& point) {
  const Cell c = grid.geometry.cell_at(point);
  return grid.geometry.contains(c) ? grid.at(c) : OccupancyGrid::kUnknown;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

void score_precision(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                     const TPose2D& truth_from_estimate, MapScores& scores) {
  const NearbyObstacle near_true(truth, scores.tolerance_m);
  std::size_t right = 0;
  for (std::size_t i = 0; i < estimate.cells.size(); ++i) {
    if (!OccupancyGrid::is_occupied(estimate.cells[i])) continue;
    const TPoint2D center = estimate.geometry.center_of(estimate.geometry.cell_of(i));
    const TPoint2D in_truth = transform(truth_from_estimate, center);
    const bool confirmed = near_true.at(in_truth);
    if (!confirmed && OccupancyGrid::is_unknown(value_at(truth, in_truth))) {
      ++scores.skipped_occupied_cells;
      continue;
    }
    ++scores.judged_occupied_cells;
    right += confirmed;
  }
  scores.precision = share(right, scores.judged_occupied_cells);
}

void score_recall_and_free(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                           const TPose2D& estimate_from_truth, MapScores& scores) {
  const NearbyObstacle near_estimated(estimate, scores.tolerance_m);
  std::size_t found = 0;
  std::size_t both_free = 0;
  std::size_t either_free = 0;
  for (std::size_t i = 0; i < truth.cells.size(); ++i) {
    const std::int8_t value = truth.cells[i];
    if (OccupancyGrid::is_unknown(value)) continue;
    const TPoint2D center = truth.geometry.center_of(truth.geometry.cell_of(i));
    const TPoint2D in_estimate = transform(estimate_from_truth, center);
    ++scores.known_true_cells;
    if (OccupancyGrid::is_occupied(value)) {
      ++scores.true_occupied_cells;
      found += near_estimated.at(in_estimate);
    }
    const bool truly_free = OccupancyGrid::is_free(value);
    const bool estimated_free = OccupancyGrid::is_free(value_at(estimate, in_estimate));
    both_free += truly_free && estimated_free;
    either_free += truly_free || estimated_free;
  }
  scores.recall = share(found, scores.true_occupied_cells);
  scores.free_iou = share(both_free, either_free);
}

}  // namespace

MapScores evaluate_map(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                       const TPose2D& truth_from_estimate, double tolerance_cells) {
  if (!(tolerance_cells >= 0.0 && tolerance_cells <= 1000.0) || !is_finite(truth_from_estimate)) {
    throw InputError("maps cannot be compared with a tolerance of " +
                     std::to_string(tolerance_cells) +
                     " cells (0 to 1000) or a pose that is not "
                     "finite");
  }
  MapScores scores;
  scores.tolerance_m = tolerance_cells * truth.geometry.resolution_m;
  score_precision(estimate, truth, truth_from_estimate, scores);
  score_recall_and_free(estimate, truth, inverse(truth_from_estimate), scores);
  return scores;
}

}  // namespace rovigo::maps
