#include "maps/free_space_evaluation.h"

#include <algorithm>
#include <cmath>

namespace rovigo::maps {

namespace {

bool stops(const OccupancyGrid& grid, const TPoint2D& p) {
  const Cell c = grid.geometry.cell_at(p);
  return !grid.geometry.contains(c) || !OccupancyGrid::is_free(grid.at(c));
}

}  // namespace

std::vector<bool> cells_in_view(const OccupancyGrid& truth, const std::vector<View>& views,
                                const FieldOfView& field) {
  return cells_in_view(truth, truth, views, field);
}

std::vector<bool> cells_in_view(const OccupancyGrid& truth, const OccupancyGrid& tall,
                                const std::vector<View>& views, const FieldOfView& field) {
  const auto& g = truth.geometry;
  std::vector<bool> seen(g.size(), false);
  const double step_m = 0.5 * g.resolution_m;
  const double step_rad = g.resolution_m / field.range_m;  // one cell at the far end
  for (const View& view : views) {
    const TPose2D& at = view.world_from_camera;
    for (double a = -field.right_rad; a <= field.left_rad; a += step_rad) {
      const double dx = std::cos(at.phi + a), dy = std::sin(at.phi + a);
      std::vector<std::size_t> passed;
      bool blocked = false, met = false;
      for (double way_m = 0.0; way_m <= field.range_m && !met; way_m += step_m) {
        const TPoint2D p{at.x + way_m * dx, at.y + way_m * dy};
        blocked = blocked || stops(truth, p);
        met = blocked && stops(tall, p);
        if (!blocked) passed.push_back(g.index_of(g.cell_at(p)));
      }
      const auto floor = static_cast<std::size_t>(std::max(0.0, field.floor_range_m) / step_m);
      if (!met) passed.resize(std::min(passed.size(), floor));
      for (const std::size_t i : passed) seen[i] = true;
    }
  }
  return seen;
}

std::optional<double> free_iou_in_view(const OccupancyGrid& estimate, const OccupancyGrid& truth,
                                       const TPose2D& truth_from_estimate,
                                       const std::vector<bool>& in_view) {
  // What was never in view is not asked for; where the estimate calls it free, it is judged.
  const TPose2D estimate_from_truth = inverse(truth_from_estimate);
  const auto& g = truth.geometry;
  int both = 0, either = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (OccupancyGrid::is_unknown(truth.cells[i])) continue;
    const Cell c =
        estimate.geometry.cell_at(transform(estimate_from_truth, g.center_of(g.cell_of(i))));
    const bool said = estimate.geometry.contains(c) && OccupancyGrid::is_free(estimate.at(c));
    const bool is = OccupancyGrid::is_free(truth.cells[i]);
    both += said && is;
    either += (is && in_view[i]) || said;
  }
  if (either == 0) return std::nullopt;
  return static_cast<double>(both) / either;
}

}  // namespace rovigo::maps
