#include "maps/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "maps/squared_distance.h"

namespace rovigo::maps {

DistanceField distance_to_occupied(const OccupancyGrid& grid) {
  DistanceField field{grid.geometry, std::vector<float>(grid.geometry.size())};
  SquaredDistanceTransform transform(grid, std::numeric_limits<double>::infinity());
  const double half_cell_m = 0.5 * grid.geometry.resolution_m;
  float* out = field.meters.data();
  for (int y = 0; y < grid.geometry.height; ++y) {
    for (const std::int64_t squared : transform.row(y)) {
      *out++ = squared == SquaredDistanceTransform::kNone
                   ? std::numeric_limits<float>::infinity()
                   : static_cast<float>(half_cell_m * std::sqrt(static_cast<double>(squared)));
    }
  }
  return field;
}

namespace {

/// Looks along one row for the occupied cell nearest to a point, leaping over cells that the field
/// says are free: nothing in this row can be nearer than the field's value there.
class RowSearch {
 public:
  RowSearch(const OccupancyGrid& grid, const DistanceField& field, const TPoint2D& point)
      : grid_(grid), field_(field), point_(point) {}

  double nearest(int y, int start_x, double best_m) const {
    const GridGeometry& g = grid_.geometry;
    const double dy = gap(point_.y, g.origin.y + y * g.resolution_m);
    for (const int direction : {1, -1}) {
      for (int x = start_x; x >= 0 && x < g.width;) {
        const double dx = gap(point_.x, g.origin.x + x * g.resolution_m);
        if (x != start_x && std::hypot(dx, dy) >= best_m) break;
        if (OccupancyGrid::is_occupied(grid_.at({x, y}))) {
          best_m = std::min(best_m, std::hypot(dx, dy));
          break;
        }
        x += direction * free_cells(field_.at({x, y}));
      }
    }
    return best_m;
  }

  /// Metres between a coordinate and the cell that begins at `low`; 0 inside it.
  double gap(double at, double low) const {
    return std::max({low - at, at - (low + grid_.geometry.resolution_m), 0.0});
  }

 private:
  /// An obstacle k cells on is at least (k - 1/2) cells from this centre; the margin covers the
  /// field's rounding to float.
  int free_cells(float distance_m) const {
    const double cells = distance_m / grid_.geometry.resolution_m + 0.5;
    return static_cast<int>(std::clamp(std::ceil(cells * (1.0 - 1e-6)), 1.0, 1e6));
  }

  const OccupancyGrid& grid_;
  const DistanceField& field_;
  const TPoint2D& point_;
};

}  // namespace

DistanceField distance_to_points(const GridGeometry& geometry,
                                 const std::vector<TPoint2D>& points) {
  OccupancyGrid marked(geometry, OccupancyGrid::kFree);
  for (const TPoint2D& p : points) {
    if (geometry.contains(p)) marked.at(geometry.cell_at(p)) = OccupancyGrid::kOccupied;
  }
  return distance_to_occupied(marked);
}

double clearance_at(const OccupancyGrid& grid, const DistanceField& field, const TPoint2D& point,
                    double limit_m) {
  const GridGeometry& g = grid.geometry;
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) return 0.0;
  if (g.size() == 0) return limit_m;
  const Cell near{std::clamp(g.cell_at(point).x, 0, g.width - 1),
                  std::clamp(g.cell_at(point).y, 0, g.height - 1)};
  const double offset_m = distance(point, g.center_of(near));
  const double field_m = field.at(near);
  if (field_m * (1.0 - 1e-6) - offset_m >= limit_m) return limit_m;

  // The distance changes by at most as much as the point moves: one bound to start from.
  double best_m = std::min(limit_m, field_m * (1.0 + 1e-6) + offset_m);
  const RowSearch search(grid, field, point);
  for (const int direction : {1, -1}) {
    for (int y = direction > 0 ? near.y : near.y - 1; y >= 0 && y < g.height; y += direction) {
      if (search.gap(point.y, g.origin.y + y * g.resolution_m) >= best_m && y != near.y) break;
      best_m = search.nearest(y, near.x, best_m);
    }
  }
  return best_m;
}

}  // namespace rovigo::maps
