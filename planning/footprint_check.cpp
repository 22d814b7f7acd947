#include "planning/footprint_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "maps/geometry.h"

namespace rovigo::planning {

namespace {

using Polygon = std::vector<TPoint2D>;

/// The part of a convex polygon where sign * coordinate <= limit (Sutherland & Hodgman 1974).
Polygon clipped(const Polygon& polygon, double TPoint2D::*coordinate, double sign, double limit) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const TPoint2D& a = polygon[i];
    const TPoint2D& b = polygon[(i + 1) % polygon.size()];
    const double beyond_a = sign * a.*coordinate - limit, beyond_b = sign * b.*coordinate - limit;
    if (beyond_a <= 0.0) out.push_back(a);
    if ((beyond_a < 0.0) == (beyond_b < 0.0) || beyond_a == beyond_b) continue;
    const double f = beyond_a / (beyond_a - beyond_b);
    out.push_back({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)});
  }
  return out;
}

double area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const TPoint2D& a = polygon[i];
    const TPoint2D& b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

double to_box(const TPoint2D& p, double half_x, double half_y) {
  return std::hypot(std::max(0.0, std::abs(p.x) - half_x), std::max(0.0, std::abs(p.y) - half_y));
}

}  // namespace

double footprint_clearance(const maps::OccupancyGrid& grid, const TPose2D& pose,
                           const FootprintSize& size, double limit_m) {
  constexpr double kTouchingM2 = 1e-10;  // overlap that rounding makes
  const auto& g = grid.geometry;
  const double u = 0.5 * size.length_m, v = 0.5 * size.width_m, half = 0.5 * g.resolution_m;
  const double c = std::cos(pose.phi), s = std::sin(pose.phi);
  const double reach = std::hypot(u, v) + limit_m;
  const maps::Cell low = g.cell_at({pose.x - reach, pose.y - reach});
  const maps::Cell high = g.cell_at({pose.x + reach, pose.y + reach});
  double best = limit_m;
  for (int y = std::max(low.y, 0); y <= std::min(high.y, g.height - 1); ++y) {
    for (int x = std::max(low.x, 0); x <= std::min(high.x, g.width - 1); ++x) {
      if (!maps::OccupancyGrid::is_occupied(grid.at({x, y}))) continue;
      const TPoint2D center = g.center_of({x, y});
      const double apart = std::hypot(center.x - pose.x, center.y - pose.y);
      if (apart - std::hypot(u, v) - std::hypot(half, half) >= best) continue;
      Polygon cell;  // in the rover's frame
      for (const auto& [right, up] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        const double dx = center.x + right * half - pose.x, dy = center.y + up * half - pose.y;
        cell.push_back({c * dx + s * dy, c * dy - s * dx});
        best = std::min(best, to_box(cell.back(), u, v));  // a corner inside has distance 0
      }
      for (const auto& [along, across] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
        const double dx = pose.x + c * along * u - s * across * v - center.x;
        const double dy = pose.y + s * along * u + c * across * v - center.y;
        best = std::min(best, to_box({dx, dy}, half, half));
      }
      Polygon common = clipped(clipped(cell, &TPoint2D::x, 1.0, u), &TPoint2D::x, -1.0, u);
      common = clipped(clipped(common, &TPoint2D::y, 1.0, v), &TPoint2D::y, -1.0, v);
      if (area(common) > kTouchingM2) return 0.0;
    }
  }
  return best;
}

}  // namespace rovigo::planning
