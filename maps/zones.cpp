#include "maps/zones.h"

#include <algorithm>
#include <cmath>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

/// The zone in cell units: cell (x, y) covers [x, x + 1] x [y, y + 1].
std::vector<TPoint2D> in_cells(const NoGoZone& zone, const GridGeometry& g) {
  std::vector<TPoint2D> corners;
  for (const TPoint2D& c : zone.corners) {
    if (!std::isfinite(c.x) || !std::isfinite(c.y)) {
      throw InputError("no-go zone \"" + zone.name + "\" has a corner that is not finite");
    }
    corners.emplace_back((c.x - g.origin.x) / g.resolution_m, (c.y - g.origin.y) / g.resolution_m);
  }
  return corners;
}

/// Occupies cells first .. last of a row, as far as they exist; the arguments may lie far outside.
void fill(OccupancyGrid& grid, int y, double first, double last) {
  const int width = grid.geometry.width;
  const int begin = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(width)));
  const int end = static_cast<int>(std::clamp(last + 1.0, 0.0, static_cast<double>(width)));
  for (int x = begin; x < end; ++x) grid.at({x, y}) = OccupancyGrid::kOccupied;
}

/// Every cell an edge touches: in each row it passes, the stretch it covers there.
void draw_edge(OccupancyGrid& grid, TPoint2D a, TPoint2D b) {
  if (a.y > b.y) std::swap(a, b);
  const auto rows = static_cast<double>(grid.geometry.height);
  const int first = static_cast<int>(std::clamp(std::ceil(a.y) - 1.0, 0.0, rows));
  const int end = static_cast<int>(std::clamp(std::floor(b.y) + 1.0, 0.0, rows));
  const auto x_at = [&](double y) {
    const double share = b.y > a.y ? (std::clamp(y, a.y, b.y) - a.y) / (b.y - a.y) : 0.0;
    return a.x + share * (b.x - a.x);
  };
  for (int y = first; y < end; ++y) {
    double low = x_at(y);
    double high = x_at(y + 1.0);
    if (a.y == b.y) high = b.x;  // level: the whole edge lies in this row
    if (low > high) std::swap(low, high);
    fill(grid, y, std::ceil(low) - 1.0, std::floor(high));
  }
}

/// Every cell whose centre is inside (odd number of crossings to its left).
void fill_inside(OccupancyGrid& grid, const std::vector<TPoint2D>& corners) {
  std::vector<double> crossings;
  for (int row = 0; row < grid.geometry.height; ++row) {
    const double y = row + 0.5;
    crossings.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const TPoint2D& a = corners[i];
      const TPoint2D& b = corners[(i + 1) % corners.size()];
      if ((a.y <= y) == (b.y <= y)) continue;
      crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      fill(grid, row, std::ceil(crossings[i] - 0.5), std::floor(crossings[i + 1] - 0.5));
    }
  }
}

}  // namespace

void apply_zones(OccupancyGrid& grid, const std::vector<NoGoZone>& zones) {
  for (const NoGoZone& zone : zones) {
    const std::vector<TPoint2D> corners = in_cells(zone, grid.geometry);
    fill_inside(grid, corners);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      draw_edge(grid, corners[i], corners[(i + 1) % corners.size()]);
    }
  }
}

OccupancyGrid keepout_mask(const GridGeometry& geometry, const std::vector<NoGoZone>& zones) {
  OccupancyGrid mask(geometry, OccupancyGrid::kFree);
  apply_zones(mask, zones);
  return mask;
}

}  // namespace rovigo::maps
