#include "planning/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rovigo::planning {

namespace {

using maps::Cell;
using maps::OccupancyGrid;

TPoint2D mix(const TPoint2D& a, const TPoint2D& b, double f) {
  return {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)};
}

double squared_distance_to_segment(const TPoint2D& p, const TPoint2D& a, const TPoint2D& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
  const double f = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
  const double ex = a.x + f * dx - p.x;
  const double ey = a.y + f * dy - p.y;
  return ex * ex + ey * ey;
}

struct Box {
  double x0, y0, x1, y1;
};

double squared_distance_to_box(const TPoint2D& p, const Box& box) {
  const double dx = std::max({box.x0 - p.x, p.x - box.x1, 0.0});
  const double dy = std::max({box.y0 - p.y, p.y - box.y1, 0.0});
  return dx * dx + dy * dy;
}

/// Does the segment meet the box? (Liang & Barsky 1984.)
bool meets(const TPoint2D& a, const TPoint2D& b, const Box& box) {
  double enter = 0.0;
  double leave = 1.0;
  const auto clip = [&](double start, double direction, double low, double high) {
    if (direction == 0.0) return start >= low && start <= high;
    const double f0 = (low - start) / direction;
    const double f1 = (high - start) / direction;
    enter = std::max(enter, std::min(f0, f1));
    leave = std::min(leave, std::max(f0, f1));
    return enter <= leave;
  };
  return clip(a.x, b.x - a.x, box.x0, box.x1) && clip(a.y, b.y - a.y, box.y0, box.y1);
}

/// Between a segment and a box: where they do not meet, the nearest pair includes an end of the
/// segment or a corner of the box.
double squared_distance(const TPoint2D& a, const TPoint2D& b, const Box& box) {
  if (meets(a, b, box)) return 0.0;
  return std::min({squared_distance_to_box(a, box), squared_distance_to_box(b, box),
                   squared_distance_to_segment({box.x0, box.y0}, a, b),
                   squared_distance_to_segment({box.x1, box.y0}, a, b),
                   squared_distance_to_segment({box.x0, box.y1}, a, b),
                   squared_distance_to_segment({box.x1, box.y1}, a, b)});
}

}  // namespace

FreeSpace::FreeSpace(const OccupancyGrid& grid, const maps::Costmap& costmap, double radius_m)
    : grid_(grid), costmap_(costmap), radius_m_(radius_m) {
  const std::size_t n = costmap.cells.size();
  if (radius_m <= 0.0) {
    room_m_.assign(n, std::numeric_limits<float>::infinity());
    return;
  }
  room_m_ = maps::distance_to_occupied(grid).meters;
  for (float& room : room_m_) room -= static_cast<float>(radius_m);
  OccupancyGrid unknown(costmap.geometry, OccupancyGrid::kFree);
  bool any = false;
  for (std::size_t i = 0; i < n; ++i) {
    if (costmap.cells[i] != maps::Costmap::kUnknown) continue;
    unknown.cells[i] = OccupancyGrid::kOccupied;
    any = true;
  }
  if (!any) return;
  const maps::DistanceField to_unknown = maps::distance_to_occupied(unknown);
  for (std::size_t i = 0; i < n; ++i) room_m_[i] = std::min(room_m_[i], to_unknown.meters[i]);
}

double FreeSpace::clearance(const TPoint2D& a, const TPoint2D& b, double limit_m) const {
  const auto& g = grid_.geometry;
  const Cell low = g.cell_at({std::min(a.x, b.x) - limit_m, std::min(a.y, b.y) - limit_m});
  const Cell high = g.cell_at({std::max(a.x, b.x) + limit_m, std::max(a.y, b.y) + limit_m});
  double best2 = limit_m * limit_m;
  for (int y = std::max(low.y, 0); y <= std::min(high.y, g.height - 1); ++y) {
    const std::int8_t* row = grid_.cells.data() + g.index_of({0, y});
    for (int x = std::max(low.x, 0); x <= std::min(high.x, g.width - 1); ++x) {
      if (!OccupancyGrid::is_occupied(row[x])) continue;
      const double x0 = g.origin.x + x * g.resolution_m;
      const double y0 = g.origin.y + y * g.resolution_m;
      const Box box{x0, y0, x0 + g.resolution_m, y0 + g.resolution_m};
      best2 = std::min(best2, squared_distance(a, b, box));
    }
  }
  return std::sqrt(best2);
}

double FreeSpace::clearance(const Path& path, double limit_m) const {
  if (path.points.empty()) return limit_m;
  // The segment with the least room is measured first, looking ever further; most others then need
  // no measuring.
  const auto segment = [&](std::size_t i) {
    return std::pair(path.points[i > 0 ? i - 1 : 0], path.points[i]);
  };
  std::size_t narrowest = 0;
  std::vector<double> room(path.points.size());
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const auto [a, b] = segment(i);
    room[i] = least_room(a, b);
    if (room[i] < room[narrowest]) narrowest = i;
  }
  double best = std::min(limit_m, 0.5);
  for (; best < limit_m; best = std::min(limit_m, 2.0 * best)) {
    const auto [a, b] = segment(narrowest);
    const double found = clearance(a, b, best);
    if (found < best) {
      best = found;
      break;
    }
  }
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    if (std::max(radius_m_, 0.0) + room[i] >= best) continue;
    const auto [a, b] = segment(i);
    best = std::min(best, clearance(a, b, best));
  }
  return best;
}

double FreeSpace::least_room(const TPoint2D& a, const TPoint2D& b) const {
  // Room changes by no more than the point moves.
  const TPoint2D middle = mix(a, b, 0.5);
  const Cell cell = geometry().cell_at(middle);
  if (!geometry().contains(cell)) return -std::numeric_limits<double>::infinity();
  return room_m_[geometry().index_of(cell)] - (maps::distance(middle, geometry().center_of(cell)) +
                                               0.5 * maps::distance(a, b) + kClearanceTolerance);
}

bool FreeSpace::is_free(const TPoint2D& p, double margin_m) const {
  if (!costmap_.is_passable(geometry().cell_at(p))) return false;
  if (radius_m_ <= 0.0) return true;
  const double need_m = radius_m_ + margin_m;
  return clearance(p, need_m) >= need_m - kClearanceTolerance;
}

bool FreeSpace::is_free(const TPoint2D& a, const TPoint2D& b, double margin_m) const {
  if (!is_passable(a, b)) return false;
  if (radius_m_ <= 0.0) return true;
  const double length = maps::distance(a, b);
  const int chunks = std::max(1, static_cast<int>(std::ceil(length / geometry().resolution_m)));
  for (int i = 0; i < chunks; ++i) {
    if (!chunk_is_clear(mix(a, b, static_cast<double>(i) / chunks),
                        mix(a, b, static_cast<double>(i + 1) / chunks), margin_m)) {
      return false;
    }
  }
  return true;
}

bool FreeSpace::chunk_is_clear(const TPoint2D& a, const TPoint2D& b, double margin_m) const {
  if (least_room(a, b) >= margin_m) return true;  // settles most chunks; the rest is measured
  const double need_m = radius_m_ + margin_m;
  return clearance(a, b, need_m) >= need_m - kClearanceTolerance;
}

bool FreeSpace::is_passable(const TPoint2D& a, const TPoint2D& b) const {
  // Amanatides & Woo 1987, in units of cells.
  const auto& g = geometry();
  Cell cell = g.cell_at(a);
  const Cell last = g.cell_at(b);
  if (!costmap_.is_passable(cell) || !costmap_.is_passable(last)) return false;
  const double ax = (a.x - g.origin.x) / g.resolution_m;
  const double ay = (a.y - g.origin.y) / g.resolution_m;
  const double dx = (b.x - g.origin.x) / g.resolution_m - ax;
  const double dy = (b.y - g.origin.y) / g.resolution_m - ay;
  const int step_x = dx > 0.0 ? 1 : -1;
  const int step_y = dy > 0.0 ? 1 : -1;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double each_x = dx != 0.0 ? 1.0 / std::abs(dx) : kNever;
  const double each_y = dy != 0.0 ? 1.0 / std::abs(dy) : kNever;
  double next_x = dx != 0.0 ? (cell.x + (step_x > 0 ? 1 : 0) - ax) / dx : kNever;
  double next_y = dy != 0.0 ? (cell.y + (step_y > 0 ? 1 : 0) - ay) / dy : kNever;
  // A crossing this close to a corner (in cells) counts as through it.
  const double corner =
      1e-9 * std::max(each_x == kNever ? 0.0 : each_x, each_y == kNever ? 0.0 : each_y);
  int left = std::abs(last.x - cell.x) + std::abs(last.y - cell.y);
  while (left > 0) {
    if (cell.x != last.x && cell.y != last.y && std::abs(next_x - next_y) <= corner) {
      if (!costmap_.is_passable({cell.x + step_x, cell.y}) ||
          !costmap_.is_passable({cell.x, cell.y + step_y})) {
        return false;
      }
    }
    // The last cell bounds the walk, whatever rounding does to the crossings.
    if (cell.y == last.y || (cell.x != last.x && next_x < next_y)) {
      cell.x += step_x;
      next_x += each_x;
    } else {
      cell.y += step_y;
      next_y += each_y;
    }
    --left;
    if (!costmap_.is_passable(cell)) return false;
  }
  return true;
}

double FreeSpace::cost(const TPoint2D& a, const TPoint2D& b, double soft_cost_weight) const {
  const double length = maps::distance(a, b);
  if (soft_cost_weight <= 0.0) return length;
  const int pieces =
      std::max(1, static_cast<int>(std::ceil(2.0 * length / geometry().resolution_m)));
  double soft = 0.0;
  for (int i = 0; i < pieces; ++i) {
    const Cell cell = geometry().cell_at(mix(a, b, (i + 0.5) / pieces));
    soft += geometry().contains(cell) ? costmap_.at(cell) : maps::Costmap::kMaxSoft;
  }
  return length * (1.0 + soft_cost_weight * soft / (pieces * maps::Costmap::kMaxSoft));
}

FreeSpace::Slope FreeSpace::slope(const TPoint2D& p) const {
  const auto& g = geometry();
  const double u = (p.x - g.origin.x) / g.resolution_m - 0.5;
  const double v = (p.y - g.origin.y) / g.resolution_m - 0.5;
  if (!(u > -1.0 && v > -1.0 && u < g.width && v < g.height)) return {};
  const int x0 = std::clamp(static_cast<int>(std::floor(u)), 0, std::max(g.width - 2, 0));
  const int y0 = std::clamp(static_cast<int>(std::floor(v)), 0, std::max(g.height - 2, 0));
  const int x1 = std::min(x0 + 1, g.width - 1);
  const int y1 = std::min(y0 + 1, g.height - 1);
  const double f = std::clamp(u - x0, 0.0, 1.0);
  const double h = std::clamp(v - y0, 0.0, 1.0);
  const double d00 = room_m_[g.index_of({x0, y0})];
  const double d10 = room_m_[g.index_of({x1, y0})];
  const double d01 = room_m_[g.index_of({x0, y1})];
  const double d11 = room_m_[g.index_of({x1, y1})];
  if (!std::isfinite(d00)) return {.room_m = std::numeric_limits<double>::infinity()};
  const double bottom = d00 + f * (d10 - d00);
  const double top = d01 + f * (d11 - d01);
  const double along_x = (1.0 - h) * (d10 - d00) + h * (d11 - d01);
  return {.room_m = bottom + h * (top - bottom),
          .gradient = {along_x / g.resolution_m, (top - bottom) / g.resolution_m}};
}

std::optional<std::vector<TPoint2D>> FreeSpace::way_round(const TPoint2D& a,
                                                          const TPoint2D& b) const {
  std::vector<TPoint2D> out;
  constexpr int kDepth = 3;
  if (!push_middle(a, b, kDepth, out)) return std::nullopt;
  return out;
}

bool FreeSpace::push_middle(const TPoint2D& a, const TPoint2D& b, int depth,
                            std::vector<TPoint2D>& out) const {
  if (is_free(a, b)) return true;
  if (depth == 0) return false;
  // A chord between two points on a circle around a corner sags by d below it; tangents at both
  // ends meet d above it. So the middle has to move by a little more than 2 d.
  const TPoint2D middle = mix(a, b, 0.5);
  const double missing = radius_m_ - clearance(a, b, radius_m_);
  const Slope at = slope(middle);
  const double norm = std::hypot(at.gradient.x, at.gradient.y);
  if (missing <= 0.0 || norm < 1e-6) return false;
  for (const double factor : {2.2, 4.0, 8.0}) {
    const double push = factor * missing / norm;
    const TPoint2D moved{middle.x + push * at.gradient.x, middle.y + push * at.gradient.y};
    if (!is_free(moved)) continue;
    const std::size_t before = out.size();
    if (push_middle(a, moved, depth - 1, out)) {
      out.push_back(moved);
      if (push_middle(moved, b, depth - 1, out)) return true;
    }
    out.resize(before);
  }
  return false;
}

bool is_free(const FreeSpace& space, const Path& path, double margin_m) {
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    if (!space.is_free(path.points[i - 1], path.points[i], margin_m)) return false;
  }
  return path.points.size() != 1 || space.is_free(path.points.front(), margin_m);
}

}  // namespace rovigo::planning
