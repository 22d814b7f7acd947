// `rovigo plan --point`: a point on the raw grid, exactly.

#include "planning/jump_point_search.h"
#include "planning/planner.h"
#include "planning/refusal.h"

namespace rovigo::planning {

namespace {

std::string what_blocks(const maps::OccupancyGrid& grid, maps::Cell cell) {
  return maps::OccupancyGrid::is_unknown(grid.at(cell))
             ? " lies on unknown ground, which map mode 0 does not enter (modes 1 and 2 do)."
             : " lies inside an obstacle.";
}

std::string map_extent(const maps::GridGeometry& g) {
  return extent_of(g.origin,
                   {g.origin.x + g.width * g.resolution_m, g.origin.y + g.height * g.resolution_m});
}

}  // namespace

struct PointPlanner::Impl {
  maps::OccupancyGrid grid;
  SearchGrid search_grid;
  JumpPointSearch search;
  GridSearch flood;  ///< for what is nearest to a goal that cannot be reached

  Impl(const maps::OccupancyGrid& g, maps::MapMode map_mode)
      : grid(g), search_grid(g, map_mode, 8), search(search_grid) {}

  void add_nearest(PointQueryResult& result, maps::Cell start, const TPoint2D& goal) {
    if (const auto cell = flood.nearest_reachable(search_grid, start, goal)) {
      result.nearest_reachable_goal = grid.geometry.center_of(*cell);
    }
    result.message += nearest_hint(result.nearest_reachable_goal);
  }
};

PointPlanner::PointPlanner(const maps::OccupancyGrid& grid, maps::MapMode map_mode)
    : impl_(std::make_unique<Impl>(grid, map_mode)) {}
PointPlanner::~PointPlanner() = default;
PointPlanner::PointPlanner(PointPlanner&&) noexcept = default;
PointPlanner& PointPlanner::operator=(PointPlanner&&) noexcept = default;

PointQueryResult PointPlanner::query(const TPoint2D& start, const TPoint2D& goal) {
  const auto& geometry = impl_->grid.geometry;
  PointQueryResult result;
  const auto refuse = [&](PlanStatus status, const TPoint2D& point, std::string message) {
    result.status = status;
    result.offending_point = point;
    result.message = std::move(message);
  };
  if (!geometry.contains(start)) {
    refuse(PlanStatus::kStartOutsideMap, start,
           "The start " + text_of(start) + " is outside the map: " + map_extent(geometry) + ".");
    return result;
  }
  const maps::Cell from = geometry.cell_at(start);
  if (!impl_->search_grid.is_passable(from)) {
    refuse(PlanStatus::kStartOccupied, start,
           "The start " + text_of(start) + what_blocks(impl_->grid, from));
    return result;
  }
  if (!geometry.contains(goal)) {
    refuse(PlanStatus::kGoalOutsideMap, goal,
           "The goal " + text_of(goal) + " is outside the map: " + map_extent(geometry) + ".");
    impl_->add_nearest(result, from, goal);
    return result;
  }
  const maps::Cell to = geometry.cell_at(goal);
  if (!impl_->search_grid.is_passable(to)) {
    refuse(PlanStatus::kGoalOccupied, goal,
           "The goal " + text_of(goal) + what_blocks(impl_->grid, to));
    impl_->add_nearest(result, from, goal);
    return result;
  }
  GridSearchResult found = impl_->search.find(from, to);
  result.expanded_cells = found.expanded_cells;
  if (!found.found) {
    refuse(PlanStatus::kNoPath, goal,
           "No way leads from the start " + text_of(start) + " to the goal " + text_of(goal) + ".");
    impl_->add_nearest(result, from, goal);
    return result;
  }
  result.status = PlanStatus::kOk;
  result.length_m = found.length_m;
  result.path.points.reserve(found.cells.size());
  for (const maps::Cell cell : found.cells) result.path.points.push_back(geometry.center_of(cell));
  return result;
}

PointQueryResult plan_point(const maps::OccupancyGrid& grid, const TPoint2D& start,
                            const TPoint2D& goal, maps::MapMode map_mode) {
  return PointPlanner(grid, map_mode).query(start, goal);
}

}  // namespace rovigo::planning
