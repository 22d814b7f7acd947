// The search of a query: in which order, over which cells, by which planner.

#include <cmath>
#include <limits>
#include <numeric>

#include "planning/cost_to_go.h"
#include "planning/footprint_planner.h"
#include "planning/plan_query.h"
#include "planning/refusal.h"
#include "planning/sampling_planner.h"
#include "planning/shortcut.h"
#include "planning/tour.h"

namespace rovigo::planning {

namespace {

void append(std::vector<TPoint2D>& points, const TPoint2D& p) {
  if (points.empty() || maps::distance(points.back(), p) > kSamePointM) points.push_back(p);
}

}  // namespace

bool PlanQuery::order_targets() {
  result_.via_order.resize(request_.via.size());
  std::iota(result_.via_order.begin(), result_.via_order.end(), std::size_t{0});
  if (request_.via_order == ViaOrder::kGiven || request_.via.size() < 2) return true;
  std::vector<TPoint2D> places{start_};
  places.insert(places.end(), targets_.begin(), targets_.end());
  const auto& g = context_.grid.geometry;
  std::vector<std::vector<double>> cost(places.size(), std::vector<double>(places.size(), 0.0));
  CostToGo ways;  // from all other places to one, at once
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const maps::Cell to = g.cell_at(places[i]);
    ways.compute(context_.search_grid, {to}, context_.config.astar.soft_cost_weight);
    for (std::size_t j = i + 1; j < places.size(); ++j) {
      const auto way = ways.way_from(g.cell_at(places[j]));
      const double length = way.cells.size() == 1 ? maps::distance(places[i], places[j])
                            : way.cells.empty()   ? std::numeric_limits<double>::infinity()
                                                  : way.length_m;
      cost[i][j] = cost[j][i] = length;
    }
  }
  const std::vector<TPoint2D> as_given = targets_;
  result_.via_order.clear();
  for (const std::size_t place : shortest_order(cost)) {
    targets_[result_.via_order.size()] = as_given[place - 1];
    result_.via_order.push_back(place - 1);
  }
  return true;  // what cannot be reached is refused leg by leg
}

bool PlanQuery::search_legs() {
  TPoint2D from = start_;
  problem_.polyline.points.push_back(from);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (!search_leg(from, targets_[i], name_of_target(i))) return false;
    from = targets_[i];
    problem_.pinned.push_back(problem_.polyline.points.size() - 1);
  }
  return true;
}

bool PlanQuery::search_leg(const TPoint2D& from, const TPoint2D& to, const std::string& name) {
  const auto& g = context_.grid.geometry;
  // Theta* asks for the shortest way: no detours for soft costs.
  const double soft_cost_weight =
      context_.kind == PlannerKind::kThetaStar ? 0.0 : context_.config.astar.soft_cost_weight;
  std::optional<SearchGrid> narrowed;  // with moves closed that prove narrower than the rover
  constexpr int kMostClosed = 50;
  for (int attempt = 0; attempt <= kMostClosed; ++attempt) {
    const SearchGrid& cells = narrowed ? *narrowed : context_.search_grid;
    const GridSearchResult found = find_way(cells, g.cell_at(from), g.cell_at(to));
    result_.expanded_cells += found.expanded_cells;
    if (!found.found) break;
    Path leg;
    append(leg.points, from);
    for (const maps::Cell cell : found.cells) append(leg.points, g.center_of(cell));
    append(leg.points, to);
    double searched_m = found.length_m;
    if (context_.footprint) {
      // A way for the centre that the rectangle may or may not fit on: it guides the sampling.
      if (!footprint_leg(name, leg)) return false;
      for (const TPoint2D& p : leg.points) {
        append(result_.grid_path.points, p);
        append(problem_.polyline.points, p);
      }
      result_.search_length_m += length_m(leg);
      return true;
    }
    if (context_.kind != PlannerKind::kAStar && context_.kind != PlannerKind::kThetaStar) {
      if (!sample_leg(from, to, name, leg)) return false;
      searched_m = length_m(leg);
    }
    const ShortcutResult straight = shortcut(context_.space, leg, soft_cost_weight);
    if (straight.ok) {
      for (const TPoint2D& p : leg.points) append(result_.grid_path.points, p);
      for (const TPoint2D& p : straight.path.points) append(problem_.polyline.points, p);
      result_.search_length_m += searched_m;
      return true;
    }
    if (!narrowed) narrowed = context_.search_grid;
    narrowed->close_move(g.cell_at(leg.points[straight.blocked]),
                         g.cell_at(leg.points[straight.blocked + 1]));
  }
  return refuse_goal(
      PlanStatus::kNoPath, to,
      "No way wide enough for robot_radius_m = " + meters(context_.inflation.robot_radius_m) +
          " leads from " + text_of(from) + " to the " + name + " " + text_of(to) + ".");
}

GridSearchResult PlanQuery::find_way(const SearchGrid& cells, maps::Cell from, maps::Cell to) {
  if (context_.kind != PlannerKind::kThetaStar) {
    return search_.find(cells, from, to,
                        {.soft_cost = context_.config.astar.soft_cost_weight,
                         .heuristic = context_.config.astar.heuristic_weight});
  }
  // Between cell centres a line may come nearer to an obstacle than the centres do.
  const auto& g = context_.grid.geometry;
  return any_angle_.find(cells, from, to, [&](maps::Cell a, maps::Cell b) {
    return context_.space.is_free(g.center_of(a), g.center_of(b));
  });
}

bool PlanQuery::sample_leg(const TPoint2D& from, const TPoint2D& to, const std::string& name,
                           Path& leg) {
  if (maps::distance(from, to) <= kSamePointM) return true;
  const SamplingResult sampled =
      sample_path(context_.space, context_.kind, from, to, context_.config.ompl, request_.seed);
  result_.expanded_cells += sampled.states;
  if (!sampled.found) return refuse_unfound(to, name);
  leg = sampled.path;
  return true;
}

bool PlanQuery::refuse_unfound(const TPoint2D& to, const std::string& name) {
  const std::string kind = to_string(context_.kind);
  const std::string way_out =
      context_.footprint ? ", although its centre could go there; the footprint may not fit, or " +
                               kind + "_iterations must be raised."
                         : ", although one exists; raise " + kind + "_iterations or use astar.";
  return refuse(PlanStatus::kTimeout, to,
                kind + " found no way to the " + name + " " + text_of(to) +
                    " within its iterations" + way_out);
}

bool PlanQuery::fits(const TPoint2D& at, std::optional<double> heading_rad) const {
  if (!heading_rad) return context_.space.is_free(at);
  return context_.footprint->is_free({at.x, at.y, *heading_rad});
}

bool PlanQuery::footprint_leg(const std::string& name, Path& leg) {
  const TPoint2D from = leg.points.front(), to = leg.points.back();
  const bool is_last = name == "goal";
  FootprintProblem problem{.space = *context_.footprint,
                           .start = from,
                           .goal = to,
                           .start_heading_rad = heading_,
                           .goal_heading_rad = {},
                           .guide = leg};
  if (!heading_ && request_.start_heading_given) problem.start_heading_rad = request_.start.phi;
  if (is_last && request_.goal_heading_given) problem.goal_heading_rad = request_.goal.phi;
  if (!fits(to, problem.goal_heading_rad)) {
    return refuse_goal(
        PlanStatus::kGoalOccupied, to,
        "At the " + name + " " + text_of(to) + " the rover's footprint touches an obstacle.");
  }
  if (maps::distance(from, to) <= kSamePointM) return true;
  const FootprintResult found =
      plan_with_footprint(problem, context_.kind, context_.config.ompl, request_.seed);
  result_.expanded_cells += found.states;
  if (!found.found) return refuse_unfound(to, name);
  leg = found.path;
  const auto& p = leg.points;
  heading_ = std::atan2(p.back().y - p[p.size() - 2].y, p.back().x - p[p.size() - 2].x);
  return true;
}

}  // namespace rovigo::planning
