// Refusals of a query, in words.

#include "planning/plan_query.h"
#include "planning/refusal.h"

namespace rovigo::planning {

bool PlanQuery::refuse(PlanStatus status, const TPoint2D& point, std::string message) {
  const std::size_t expanded = result_.expanded_cells;
  result_ = PlanResult();
  result_.status = status;
  result_.expanded_cells = expanded;
  result_.offending_point = point;
  result_.message = std::move(message);
  return false;
}

bool PlanQuery::refuse_goal(PlanStatus status, const TPoint2D& point, std::string message) {
  refuse(status, point, std::move(message));
  const auto& g = context_.grid.geometry;
  if (const auto cell = search_.nearest_reachable(context_.search_grid, g.cell_at(start_), point)) {
    result_.nearest_reachable_goal = g.center_of(*cell);
  }
  result_.message += nearest_hint(result_.nearest_reachable_goal);
  return false;
}

std::string PlanQuery::why_not_free(const TPoint2D& point) const {
  const maps::Cell cell = context_.grid.geometry.cell_at(point);
  if (maps::OccupancyGrid::is_occupied(context_.grid.at(cell))) return " lies inside an obstacle";
  const double radius = context_.inflation.robot_radius_m;
  const double clearance = context_.space.clearance(point, radius);
  if (clearance < radius) {
    return " is " + meters(clearance) +
           " from an obstacle, nearer than robot_radius_m = " + meters(radius);
  }
  return " lies on unknown ground, which map mode 0 does not enter (modes 1 and 2 do)";
}

std::string PlanQuery::map_extent() const {
  const auto& g = context_.grid.geometry;
  return extent_of(g.origin,
                   {g.origin.x + g.width * g.resolution_m, g.origin.y + g.height * g.resolution_m});
}

std::string PlanQuery::name_of_target(std::size_t index) const {
  if (index == request_.via.size()) return "goal";
  const std::size_t given = result_.via_order.empty() ? index : result_.via_order[index];
  return "via point " + std::to_string(given + 1);
}

}  // namespace rovigo::planning
