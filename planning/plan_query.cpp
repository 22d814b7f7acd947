#include "planning/plan_query.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "planning/check.h"
#include "planning/cost_to_go.h"
#include "planning/escape.h"
#include "planning/reference_spline.h"
#include "planning/refusal.h"
#include "planning/sampling_planner.h"
#include "planning/shortcut.h"
#include "planning/timing.h"
#include "planning/tour.h"

namespace rovigo::planning {

namespace {

/// Path points this near to each other are one.
constexpr double kSamePointM = 1e-6;
/// Clearances are reported up to this; further is open ground.
constexpr double kClearanceReportedM = 10.0;

void append(std::vector<TPoint2D>& points, const TPoint2D& p) {
  if (points.empty() || maps::distance(points.back(), p) > kSamePointM) points.push_back(p);
}

std::string meters(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", value);
  return text;
}

PlannerConfig validated(const PlannerConfig& config) {
  validate(config);
  return config;
}

}  // namespace

PlanningContext::PlanningContext(const maps::OccupancyGrid& g, const maps::RobotModel& r,
                                 const maps::InflationConfig& i, const PlannerConfig& c)
    : grid(g),
      robot(r),
      inflation(i),
      config(validated(c)),
      kind(parse_planner_kind(c.planner).value_or(PlannerKind::kAStar)),
      costmap(maps::inflate_safe(grid, i)),
      search_grid(costmap, c.astar.connectivity),
      space(grid, costmap, i.map_mode == maps::MapMode::kEverything ? 0.0 : i.robot_radius_m) {}

PlanResult PlanQuery::run() {
  begin(PlanStage::kSearch);
  if (settle_start() && settle_targets() && order_targets() && search_legs()) {
    result_.status = PlanStatus::kOk;
    begin(PlanStage::kSmooth);
    smooth_path();
    begin(PlanStage::kTime);
    time_path();
    measure();
  }
  begin(PlanStage::kDone);
  return std::move(result_);
}

bool PlanQuery::settle_start() {
  const TPoint2D given = maps::position_of(request_.start);
  const auto& g = context_.grid.geometry;
  if (!g.contains(given)) {
    return refuse(PlanStatus::kStartOutsideMap, given,
                  "The start " + text_of(given) + " is outside the map: " + map_extent() + ".");
  }
  start_ = given;
  if (context_.space.is_free(given)) return true;
  const double reach = context_.config.escape_max_distance_m;
  if (const auto way = find_escape(context_.grid, context_.space, given, reach)) {
    escape_ = *way;
    start_ = way->back();
    result_.escape = true;
    return true;
  }
  return refuse(PlanStatus::kStartOccupied, given,
                "The start " + text_of(given) + why_not_free(given) +
                    " and no free ground lies within " + meters(reach) +
                    " of it (escape_max_distance_m); move the start.");
}

bool PlanQuery::settle_targets() {
  std::vector<TPoint2D> given = request_.via;
  given.push_back(maps::position_of(request_.goal));
  for (const TPoint2D& target : given) {
    const std::string name = "The " + name_of_target(targets_.size());
    if (!context_.grid.geometry.contains(target)) {
      return refuse_goal(
          PlanStatus::kGoalOutsideMap, target,
          name + " " + text_of(target) + " is outside the map: " + map_extent() + ".");
    }
    const auto near = free_point_in_cell(context_.space, target);
    if (!near) {
      return refuse_goal(PlanStatus::kGoalOccupied, target,
                         name + " " + text_of(target) + why_not_free(target) + ".");
    }
    targets_.push_back(*near);
    if (maps::distance(*near, target) > kSamePointM) {
      result_.message += name + " was moved by " + meters(maps::distance(*near, target)) + " to " +
                         text_of(*near) +
                         " to keep robot_radius_m = " + meters(context_.inflation.robot_radius_m) +
                         " clear. ";
    }
  }
  return true;
}

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
  if (!sampled.found) {
    return refuse(PlanStatus::kTimeout, to,
                  std::string(to_string(context_.kind)) + " found no way to the " + name + " " +
                      text_of(to) + " within its iterations, although one exists; raise " +
                      to_string(context_.kind) + "_iterations or use astar.");
  }
  leg = sampled.path;
  return true;
}

bool PlanQuery::is_reference() const { return context_.config.spline.mode == "reference"; }

void PlanQuery::reference_path() {
  std::vector<TPoint2D> cells;  // in cells, the smoothing factor's unit
  for (const TPoint2D& p : result_.grid_path.points) {
    const double scale = 1.0 / context_.grid.geometry.resolution_m;
    cells.push_back({p.x * scale, p.y * scale});
  }
  while (cells.size() < 4) {  // a cubic needs four
    for (std::size_t i = cells.size() - 1; i > 0; --i) {
      const TPoint2D middle{0.5 * (cells[i - 1].x + cells[i].x),
                            0.5 * (cells[i - 1].y + cells[i].y)};
      cells.insert(cells.begin() + static_cast<std::ptrdiff_t>(i), middle);
    }
  }
  const double s = context_.config.spline.smoothing_cells2;
  const CubicBSpline curve =
      reference_spline(cells, s < 0.0 ? default_smoothing(cells.size()) : s).curve;
  std::vector<TPoint2D> control = curve.control_points();
  for (TPoint2D& c : control) c *= context_.grid.geometry.resolution_m;
  pieces_.push_back({.curve = CubicBSpline(curve.knots(), std::move(control))});
}

void PlanQuery::smooth_path() {
  if (problem_.polyline.points.size() < 2) return;
  if (is_reference()) return reference_path();
  const auto wanted = [&](bool given, double heading, const TPoint2D& a, const TPoint2D& b) {
    const double along = std::atan2(b.y - a.y, b.x - a.x);
    const double off = std::abs(maps::wrap_angle(heading - along));
    return given && off <= context_.config.timing.turn_first_threshold_rad;
  };
  const auto& p = problem_.polyline.points;
  if (escape_.empty() && wanted(request_.start_heading_given, request_.start.phi, p[0], p[1])) {
    problem_.start_heading_rad = request_.start.phi;
  }
  if (wanted(request_.goal_heading_given, request_.goal.phi, p[p.size() - 2], p.back())) {
    problem_.goal_heading_rad = request_.goal.phi;
  }
  pieces_ = smooth(context_.space, problem_, context_.config.spline);
}

void PlanQuery::time_path() {
  time_pieces(pieces_);
  if (is_reference() || is_safe(pieces_, result_.trajectory)) return;
  // Never expected; but a plan that fails its own check is not handed out.
  SplineConfig straight = context_.config.spline;
  straight.smooth = false;
  problem_.start_heading_rad.reset();
  problem_.goal_heading_rad.reset();
  pieces_ = smooth(context_.space, problem_, straight);
  time_pieces(pieces_);
}

void PlanQuery::time_pieces(const std::vector<PathPiece>& pieces) {
  const auto& config = context_.config.timing;
  TimingProblem timing;
  timing.pieces = escape_pieces();
  timing.at = start_;
  timing.room_m = [this](const TPoint2D& p) { return context_.space.slope(p).room_m; };
  timing.pieces.insert(timing.pieces.end(), pieces.begin(), pieces.end());
  if (request_.start_heading_given) timing.start_heading_rad = request_.start.phi;
  if (request_.goal_heading_given) timing.goal_heading_rad = request_.goal.phi;
  result_.trajectory = planning::time_path(timing, limits_of(context_.robot, config), config);
  result_.smooth_path = sampled(timing.pieces, context_.config.spline.sample_spacing_m);
  if (result_.smooth_path.points.empty()) result_.smooth_path.points.push_back(start_);
}

std::vector<PathPiece> PlanQuery::escape_pieces() const {
  std::vector<PathPiece> pieces;
  for (std::size_t i = 1; i < escape_.size(); ++i) {
    if (maps::distance(escape_[i - 1], escape_[i]) <= kSamePointM) continue;
    pieces.push_back({.curve = CubicBSpline::uniform({escape_[i - 1], escape_[i]}), .slow = true});
  }
  return pieces;
}

bool PlanQuery::is_safe(const std::vector<PathPiece>& pieces, const Trajectory& trajectory) const {
  if (pieces.empty()) return true;
  // Free driving begins where the escape ends; before that the trajectory is not expected free.
  bool escaping = !escape_.empty();
  for (std::size_t i = 1; i < trajectory.points.size(); ++i) {
    const TPoint2D a = maps::position_of(trajectory.points[i - 1].pose);
    const TPoint2D b = maps::position_of(trajectory.points[i].pose);
    if (escaping) {
      escaping = maps::distance(a, start_) > kSamePointM;
      if (escaping) continue;
    }
    if (!context_.space.is_free(a, b)) return false;
  }
  return true;
}

void PlanQuery::measure() {
  result_.path_length_m = length_m(result_.trajectory);
  Path driven;
  driven.points.reserve(result_.trajectory.points.size());
  for (const auto& p : result_.trajectory.points)
    driven.points.push_back(maps::position_of(p.pose));
  result_.min_clearance_m =
      context_.space.clearance(driven, kClearanceReportedM) - context_.inflation.robot_radius_m;
  if (result_.escape) {
    result_.message +=
        "The start is nearer to an obstacle than robot_radius_m or on unknown "
        "ground; the first " +
        meters(length_m(Path{escape_})) + " leave it slowly. ";
  }
  if (is_reference()) report_cuts();
  if (!result_.message.empty()) result_.message.pop_back();  // the last space
}

void PlanQuery::report_cuts() {
  if (context_.inflation.map_mode == maps::MapMode::kEverything) return;
  CheckOptions options;
  options.robot_radius_m = context_.inflation.robot_radius_m;
  options.limits = limits_of(context_.robot, context_.config.timing);
  options.escape_allowed = result_.escape;
  options.unknown_is_blocked = context_.inflation.map_mode == maps::MapMode::kKnownFree;
  options.clearance_looked_m = context_.inflation.robot_radius_m + 0.1;
  const TrajectoryReport report = check(result_.trajectory, context_.grid, options);
  result_.unsafe_samples = report.unsafe_samples;
  if (report.unsafe_samples == 0) return;
  result_.message += "This reference spline is not safe to drive: it comes within " +
                     meters(report.min_clearance_m) +
                     " of an obstacle or enters blocked ground, "
                     "where robot_radius_m = " +
                     meters(context_.inflation.robot_radius_m) +
                     " must stay clear; spline_mode = safe keeps it. ";
}

void PlanQuery::begin(PlanStage stage) const {
  if (request_.on_stage) request_.on_stage(stage);
}

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
