#include "planning/footprint.h"

#include <algorithm>
#include <cmath>

namespace rovigo::planning {

namespace {

constexpr double kTurnStepRad = 0.02;
constexpr double kHalfTurnSlackRad = 0.01;  // nearer to half a turn, its sense is left to rounding

/// How much further than the inscribed radius the centre must be from everything, that the heading
/// need not be looked at.
double spare_m(const Footprint& footprint, const FreeSpace& centers) {
  return std::max(0.0, footprint.circumscribed_radius_m() - centers.radius_m());
}

}  // namespace

double Footprint::inscribed_radius_m() const { return std::min(half_length_m, half_width_m); }
double Footprint::circumscribed_radius_m() const { return std::hypot(half_length_m, half_width_m); }

Footprint footprint_of(const maps::RobotModel& robot) {
  return {0.5 * robot.footprint_length_m, 0.5 * robot.footprint_width_m};
}

std::vector<std::vector<TPoint2D>> footprint_outlines(const Trajectory& trajectory,
                                                      const Footprint& footprint,
                                                      double spacing_m) {
  constexpr double kTurnShownRad = 0.4;
  std::vector<std::vector<TPoint2D>> out;
  TPose2D last;
  for (std::size_t i = 0; i < trajectory.points.size(); ++i) {
    const TPose2D& at = trajectory.points[i].pose;
    const bool is_end = i + 1 == trajectory.points.size();
    if (!out.empty() && !is_end &&
        maps::distance(maps::position_of(at), maps::position_of(last)) < spacing_m &&
        std::abs(maps::wrap_angle(at.phi - last.phi)) < kTurnShownRad) {
      continue;
    }
    last = at;
    const double c = std::cos(at.phi), s = std::sin(at.phi);
    std::vector<TPoint2D> outline;
    for (const auto& [along, across] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}, {1, 1}}) {
      const double u = along * footprint.half_length_m, v = across * footprint.half_width_m;
      outline.push_back({at.x + c * u - s * v, at.y + s * u + c * v});
    }
    out.push_back(std::move(outline));
  }
  return out;
}

/// A rectangle anywhere.
struct FootprintSpace::Box {
  TPoint2D center;
  double c = 1.0;  ///< cosine and sine of its heading
  double s = 0.0;
  double half_length = 0.0;
  double half_width = 0.0;

  double reach_x() const { return std::abs(c) * half_length + std::abs(s) * half_width; }
  double reach_y() const { return std::abs(s) * half_length + std::abs(c) * half_width; }
};

FootprintSpace::FootprintSpace(const maps::OccupancyGrid& grid, const FreeSpace& centers,
                               const Footprint& footprint, double margin_m)
    : grid_(grid),
      centers_(centers),
      footprint_{footprint.half_length_m + margin_m, footprint.half_width_m + margin_m} {}

/// Two convex shapes are apart when a line along one of their edges separates them.
bool FootprintSpace::overlaps(const Box& box, const TPoint2D& cell_center) const {
  const double half = 0.5 * grid_.geometry.resolution_m;
  const double dx = cell_center.x - box.center.x, dy = cell_center.y - box.center.y;
  const double cell_reach = half * (std::abs(box.c) + std::abs(box.s));
  return std::abs(dx) < box.reach_x() + half && std::abs(dy) < box.reach_y() + half &&
         std::abs(box.c * dx + box.s * dy) < box.half_length + cell_reach &&
         std::abs(box.c * dy - box.s * dx) < box.half_width + cell_reach;
}

bool FootprintSpace::is_free(const Box& box) const {
  const auto& g = grid_.geometry;
  const maps::Cell low = g.cell_at({box.center.x - box.reach_x(), box.center.y - box.reach_y()});
  const maps::Cell high = g.cell_at({box.center.x + box.reach_x(), box.center.y + box.reach_y()});
  for (int y = std::max(low.y, 0); y <= std::min(high.y, g.height - 1); ++y) {
    for (int x = std::max(low.x, 0); x <= std::min(high.x, g.width - 1); ++x) {
      if (maps::OccupancyGrid::is_occupied(grid_.at({x, y})) && overlaps(box, g.center_of({x, y})))
        return false;
    }
  }
  return true;
}

bool FootprintSpace::is_free(const TPose2D& pose) const {
  const TPoint2D at = maps::position_of(pose);
  if (!centers_.is_free(at)) return false;
  if (centers_.is_free(at, spare_m(footprint_, centers_))) return true;
  return is_free(Box{at, std::cos(pose.phi), std::sin(pose.phi), footprint_.half_length_m,
                     footprint_.half_width_m});
}

bool FootprintSpace::drive_is_free(const TPoint2D& a, const TPoint2D& b) const {
  if (!centers_.is_free(a, b)) return false;
  if (centers_.is_free(a, b, spare_m(footprint_, centers_))) return true;
  const double length = maps::distance(a, b);
  if (length <= 0.0) return true;  // a turn decides
  return is_free(Box{{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)},
                     (b.x - a.x) / length,
                     (b.y - a.y) / length,
                     0.5 * length + footprint_.half_length_m,
                     footprint_.half_width_m});
}

std::vector<TPoint2D> FootprintSpace::obstacles_near(const TPoint2D& at, double reach_m) const {
  const auto& g = grid_.geometry;
  const maps::Cell low = g.cell_at({at.x - reach_m, at.y - reach_m});
  const maps::Cell high = g.cell_at({at.x + reach_m, at.y + reach_m});
  std::vector<TPoint2D> out;
  for (int y = std::max(low.y, 0); y <= std::min(high.y, g.height - 1); ++y) {
    for (int x = std::max(low.x, 0); x <= std::min(high.x, g.width - 1); ++x) {
      if (maps::OccupancyGrid::is_occupied(grid_.at({x, y}))) out.push_back(g.center_of({x, y}));
    }
  }
  return out;
}

bool FootprintSpace::turn_is_free(const TPoint2D& at, double from_rad, double to_rad) const {
  if (!centers_.is_free(at)) return false;
  if (centers_.is_free(at, spare_m(footprint_, centers_))) return true;
  double by = maps::wrap_angle(to_rad - from_rad);
  if (std::abs(by) > maps::kPi - kHalfTurnSlackRad) by = 2.0 * maps::kPi;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(by) / kTurnStepRad)));
  // Between two headings no point of the rectangle is further than this from where one has it.
  const double between = footprint_.circumscribed_radius_m() * 0.5 * std::abs(by) / steps;
  Box box{.center = at,
          .half_length = footprint_.half_length_m + between,
          .half_width = footprint_.half_width_m + between};
  const auto obstacles = obstacles_near(at, footprint_.circumscribed_radius_m() + 2.0 * between);
  for (int i = 0; i <= steps; ++i) {
    const double heading = from_rad + by * i / steps;
    box.c = std::cos(heading);
    box.s = std::sin(heading);
    for (const TPoint2D& obstacle : obstacles) {
      if (overlaps(box, obstacle)) return false;
    }
  }
  return true;
}

}  // namespace rovigo::planning
