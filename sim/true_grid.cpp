// What the world really is, as a grid: for scoring only.

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <vector>

#include "maps/error.h"
#include "sim/simulator.h"
#include "sim/world_model.h"

namespace rovigo::sim {
namespace {

using Polygon = std::vector<TPoint2D>;  // convex, counter-clockwise

double cross(const TPoint2D& o, const TPoint2D& a, const TPoint2D& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Monotone chain (Andrew 1979).
Polygon convex_hull(Polygon points) {
  std::sort(points.begin(), points.end(), [](const TPoint2D& a, const TPoint2D& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  if (points.size() < 3) return points;
  Polygon hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The outline on the floor of the part of a convex solid between two heights.
Polygon section_between(const Solid& solid, double low, double high) {
  const auto corners = corners_of(solid);
  Polygon points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& a = corners[i];
    if (a.z() >= low && a.z() <= high) points.push_back({a.x(), a.y()});
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const auto& b = corners[j];
      for (const double z : {low, high}) {
        if ((a.z() - z) * (b.z() - z) >= 0.0) continue;
        const double t = (z - a.z()) / (b.z() - a.z());
        points.push_back({a.x() + t * (b.x() - a.x()), a.y() + t * (b.y() - a.y())});
      }
    }
  }
  return convex_hull(std::move(points));
}

/// Do a convex polygon and an axis-aligned square share area? (separating axes)
bool overlaps(const Polygon& polygon, const TPoint2D& low, const TPoint2D& high) {
  constexpr double kSliverM = 1e-6;  // a surface exactly on a cell's border is not in the cell
  double min_x = 1e18, max_x = -1e18, min_y = 1e18, max_y = -1e18;
  for (const auto& p : polygon) {
    min_x = std::min(min_x, p.x);
    max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y);
    max_y = std::max(max_y, p.y);
  }
  if (min_x > high.x - kSliverM || max_x < low.x + kSliverM || min_y > high.y - kSliverM ||
      max_y < low.y + kSliverM) {
    return false;
  }
  const TPoint2D square[4] = {low, {high.x, low.y}, high, {low.x, high.y}};
  for (std::size_t i = 0; i < polygon.size() && polygon.size() >= 3; ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const bool all_outside = std::all_of(std::begin(square), std::end(square), [&](const auto& c) {
      return cross(a, b, c) < kSliverM * length;
    });
    if (all_outside) return false;
  }
  return true;
}

void mark(maps::OccupancyGrid& grid, const Polygon& polygon) {
  if (polygon.empty()) return;
  const auto& g = grid.geometry;
  TPoint2D low{1e18, 1e18};
  TPoint2D high{-1e18, -1e18};
  for (const auto& p : polygon) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const auto first = g.cell_at(low);
  const auto last = g.cell_at(high);
  for (int y = std::max(0, first.y); y <= std::min(g.height - 1, last.y); ++y) {
    for (int x = std::max(0, first.x); x <= std::min(g.width - 1, last.x); ++x) {
      const auto c = g.center_of({x, y});
      const double h = g.resolution_m / 2;
      if (overlaps(polygon, {c.x - h, c.y - h}, {c.x + h, c.y + h})) {
        grid.at({x, y}) = maps::OccupancyGrid::kOccupied;
      }
    }
  }
}

/// Inside the world is what can be reached from the start without crossing an obstacle.
void flood_free(maps::OccupancyGrid& grid, const TPoint2D& start) {
  const auto& g = grid.geometry;
  const maps::Cell seed = g.cell_at(start);
  if (!g.contains(seed)) return;
  std::deque<maps::Cell> open{seed};
  if (grid.at(seed) == maps::OccupancyGrid::kUnknown) grid.at(seed) = maps::OccupancyGrid::kFree;
  while (!open.empty()) {
    const maps::Cell c = open.front();
    open.pop_front();
    for (const auto& d : {maps::Cell{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const maps::Cell n{c.x + d.x, c.y + d.y};
      if (!g.contains(n) || grid.at(n) != maps::OccupancyGrid::kUnknown) continue;
      grid.at(n) = maps::OccupancyGrid::kFree;
      open.push_back(n);
    }
  }
}

}  // namespace

maps::OccupancyGrid true_grid(const World& world, double resolution_m, double min_height_m,
                              double max_height_m) {
  constexpr double kMarginCells = 2.0;
  constexpr std::size_t kMaxCells = 64U << 20U;
  Bounds bounds = bounds_of(world.model());
  const TPoint2D start = maps::position_of(world.start());
  bounds.min = {std::min(bounds.min.x, start.x), std::min(bounds.min.y, start.y)};
  bounds.max = {std::max(bounds.max.x, start.x), std::max(bounds.max.y, start.y)};
  maps::GridGeometry geometry;
  geometry.resolution_m = resolution_m;
  // Cell borders on multiples of the resolution, so that grids of one world line up.
  const auto down = [&](double v) { return std::floor(v / resolution_m) - kMarginCells; };
  const auto up = [&](double v) { return std::ceil(v / resolution_m) + kMarginCells; };
  geometry.origin = {down(bounds.min.x) * resolution_m, down(bounds.min.y) * resolution_m};
  geometry.width = static_cast<int>(up(bounds.max.x) - down(bounds.min.x));
  geometry.height = static_cast<int>(up(bounds.max.y) - down(bounds.min.y));
  if (geometry.size() > kMaxCells) {
    throw maps::InputError("the true grid of world '" + world.name() + "' would have " +
                           std::to_string(geometry.size()) + " cells; the limit is " +
                           std::to_string(kMaxCells) + "; choose a coarser resolution");
  }
  maps::OccupancyGrid grid(geometry);
  for (const auto& solid : world.model().solids) {
    if (solid.visible) mark(grid, section_between(solid, min_height_m, max_height_m));
  }
  flood_free(grid, start);
  return grid;
}

}  // namespace rovigo::sim
