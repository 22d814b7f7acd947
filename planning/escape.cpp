#include "planning/escape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "planning/search_grid.h"

namespace rovigo::planning {

namespace {

using maps::Cell;

class EscapeSearch {
 public:
  EscapeSearch(const maps::OccupancyGrid& grid, const FreeSpace& space, const TPoint2D& start,
               double max_distance_m)
      : grid_(grid), space_(space), start_(start), max_distance_m_(max_distance_m) {
    // Where the start has room enough and only stands on unknown ground, the radius is kept.
    floor_m_ = std::min(space.clearance(start, space.radius_m() + 1.0), space.radius_m());
  }

  bool touches() const { return space_.radius_m() > 0.0 && floor_m_ <= 0.0; }

  std::optional<std::vector<TPoint2D>> straight() const {
    const auto& g = grid_.geometry;
    const Cell middle = g.cell_at(start_);
    const int reach = static_cast<int>(std::min(1e4, max_distance_m_ / g.resolution_m)) + 1;
    std::vector<std::pair<double, Cell>> candidates;
    for (int y = middle.y - reach; y <= middle.y + reach; ++y) {
      for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
        if (!space_.costmap().is_passable({x, y})) continue;
        const double d = maps::distance(start_, g.center_of({x, y}));
        if (d <= max_distance_m_ && space_.is_free(g.center_of({x, y}))) {
          candidates.push_back({d, {x, y}});
        }
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [d, cell] : candidates) {
      const TPoint2D center = g.center_of(cell);
      if (keeps(center, floor_m_)) return std::vector<TPoint2D>{start_, center};
    }
    return std::nullopt;
  }

  /// Dijkstra over cell centres that are at most one cell nearer to obstacles than the start.
  std::optional<std::vector<TPoint2D>> over_cells() const {
    const auto& g = grid_.geometry;
    const double floor = std::max(floor_m_ - g.resolution_m, 0.01 * g.resolution_m);
    const Cell from = g.cell_at(start_);
    const int reach = static_cast<int>(std::min(1e3, max_distance_m_ / g.resolution_m)) + 1;
    const int side = 2 * reach + 1;
    const auto local = [&](Cell c) {
      return static_cast<std::size_t>(c.y - from.y + reach) * static_cast<std::size_t>(side) +
             static_cast<std::size_t>(c.x - from.x + reach);
    };
    std::vector<double> cost(static_cast<std::size_t>(side) * static_cast<std::size_t>(side),
                             std::numeric_limits<double>::infinity());
    std::vector<Cell> parent(cost.size());
    using Item = std::pair<double, std::size_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
    cost[local(from)] = 0.0;
    open.push({0.0, local(from)});
    while (!open.empty()) {
      const auto [c, index] = open.top();
      open.pop();
      if (c > cost[index]) continue;
      const Cell cell{from.x - reach + static_cast<int>(index) % side,
                      from.y - reach + static_cast<int>(index) / side};
      if (space_.is_free(g.center_of(cell))) return trace(parent, local, from, cell);
      for (const Move& move : kMoves) {
        const Cell next{cell.x + move.dx, cell.y + move.dy};
        if (!g.contains(next) || std::abs(next.x - from.x) > reach ||
            std::abs(next.y - from.y) > reach) {
          continue;
        }
        const TPoint2D a = cell == from ? start_ : g.center_of(cell);
        const double total = c + maps::distance(a, g.center_of(next));
        if (total >= cost[local(next)] || total > max_distance_m_ ||
            space_.clearance(a, g.center_of(next), floor_m_ + g.resolution_m) < floor) {
          continue;
        }
        cost[local(next)] = total;
        parent[local(next)] = cell;
        open.push({total, local(next)});
      }
    }
    return std::nullopt;
  }

 private:
  bool keeps(const TPoint2D& end, double floor_m) const {
    const double limit_m = std::max(space_.radius_m(), grid_.geometry.resolution_m);
    const double clearance_m = space_.clearance(start_, end, limit_m);
    return clearance_m > 0.0 && clearance_m >= floor_m - kClearanceTolerance;
  }

  template <class Local>
  std::vector<TPoint2D> trace(const std::vector<Cell>& parent, const Local& local, Cell from,
                              Cell cell) const {
    std::vector<TPoint2D> way;
    for (; !(cell == from); cell = parent[local(cell)]) {
      way.push_back(grid_.geometry.center_of(cell));
    }
    way.push_back(start_);
    std::reverse(way.begin(), way.end());
    return way;
  }

  const maps::OccupancyGrid& grid_;
  const FreeSpace& space_;
  TPoint2D start_;
  double max_distance_m_;
  double floor_m_ = 0.0;
};

}  // namespace

std::optional<std::vector<TPoint2D>> find_escape(const maps::OccupancyGrid& grid,
                                                 const FreeSpace& space, const TPoint2D& start,
                                                 double max_distance_m) {
  const EscapeSearch search(grid, space, start, max_distance_m);
  if (search.touches()) return std::nullopt;
  if (const auto near = free_point_in_cell(space, start)) return std::vector{start, *near};
  if (auto way = search.straight()) return way;
  return search.over_cells();
}

std::optional<TPoint2D> free_point_in_cell(const FreeSpace& space, const TPoint2D& point) {
  const auto& g = space.geometry();
  const maps::Cell cell = g.cell_at(point);
  if (!g.contains(cell)) return std::nullopt;
  if (space.is_free(point)) return point;
  const TPoint2D center = g.center_of(cell);
  if (!space.is_free(center)) return std::nullopt;
  double low = 0.0;  // not free
  double high = 1.0;
  const auto at = [&](double f) {
    return TPoint2D{point.x + f * (center.x - point.x), point.y + f * (center.y - point.y)};
  };
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (space.is_free(at(middle)) ? high : low) = middle;
  }
  return at(high);
}

}  // namespace rovigo::planning
