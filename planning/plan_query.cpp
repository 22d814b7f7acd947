#include "planning/plan_query.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "planning/check.h"
#include "planning/escape.h"
#include "planning/reference_spline.h"
#include "planning/refusal.h"
#include "planning/timing.h"

namespace rovigo::planning {

namespace {

/// Kept around the rectangle: covers what rounding and the time steps of a trajectory move.
constexpr double kFootprintMarginM = 0.005;
/// The rectangle's clearance is reported up to this.
constexpr double kFootprintClearanceReportedM = 0.3;
/// Clearances are reported up to this; further is open ground.
constexpr double kClearanceReportedM = 10.0;

PlannerConfig validated(const PlannerConfig& config) {
  validate(config);
  return config;
}

/// The centre's distance to obstacles alone decides for the circle; for the rectangle it must be at
/// least the inscribed radius.
maps::InflationConfig inflation_for(const maps::RobotModel& robot, maps::InflationConfig inflation,
                                    const PlannerConfig& config) {
  if (plans_with_rectangle(config)) {
    inflation.robot_radius_m = footprint_of(robot).inscribed_radius_m();
  }
  return inflation;
}

}  // namespace

PlanningContext::PlanningContext(const maps::OccupancyGrid& g, const maps::RobotModel& r,
                                 const maps::InflationConfig& i, const PlannerConfig& c,
                                 const maps::Costmap* ready)
    : grid(g),
      robot(r),
      inflation(inflation_for(r, i, c)),
      config(validated(c)),
      kind(parse_planner_kind(c.planner).value_or(PlannerKind::kAStar)),
      costmap(ready ? *ready : maps::inflate_safe(grid, inflation)),
      search_grid(costmap, c.astar.connectivity),
      space(grid, costmap,
            i.map_mode == maps::MapMode::kEverything ? 0.0 : inflation.robot_radius_m) {
  if (plans_with_rectangle(config))
    footprint.emplace(grid, space, footprint_of(robot), kFootprintMarginM);
}

PlanResult PlanQuery::run() {
  begin(PlanStage::kSearch);
  if (settle_start() && settle_targets() && order_targets() && search_legs()) {
    result_.status = PlanStatus::kOk;
    begin(PlanStage::kSmooth);
    smooth_path();
    begin(PlanStage::kTime);
    time_path();
    if (!context_.footprint || footprint_is_safe()) measure();
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
  if (context_.footprint) {
    if (fits(given,
             request_.start_heading_given ? std::optional(request_.start.phi) : std::nullopt))
      return true;
    return refuse(PlanStatus::kStartOccupied, given,
                  "At the start " + text_of(given) + " the rover's footprint touches an obstacle.");
  }
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

bool PlanQuery::is_reference() const {
  return context_.config.spline.mode == "reference" && !context_.footprint;
}

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
  if (context_.footprint) return straight_path();
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

/// The rectangle's way is not rounded: it was checked as it is, turns on the spot and straight
/// legs.
void PlanQuery::straight_path() {
  const auto& points = problem_.polyline.points;
  for (std::size_t i = 1; i < points.size(); ++i) {
    pieces_.push_back({.curve = CubicBSpline::uniform({points[i - 1], points[i]})});
  }
}

void PlanQuery::time_path() {
  time_pieces(pieces_);
  if (context_.footprint || is_reference() || is_safe(pieces_, result_.trajectory)) return;
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

bool PlanQuery::footprint_is_safe() {
  if (context_.inflation.map_mode == maps::MapMode::kEverything) return true;
  CheckOptions options;
  options.footprint = {context_.robot.footprint_length_m, context_.robot.footprint_width_m};
  options.limits = limits_of(context_.robot, context_.config.timing);
  options.unknown_is_blocked = context_.inflation.map_mode == maps::MapMode::kKnownFree;
  options.clearance_looked_m = kFootprintClearanceReportedM;
  const TrajectoryReport report = check(result_.trajectory, context_.grid, options);
  result_.min_clearance_m = report.min_clearance_m;
  return report.unsafe_samples == 0 || refuse_unfound(targets_.back(), "goal");
}

void PlanQuery::measure() {
  result_.path_length_m = length_m(result_.trajectory);
  Path driven;
  driven.points.reserve(result_.trajectory.points.size());
  for (const auto& p : result_.trajectory.points)
    driven.points.push_back(maps::position_of(p.pose));
  if (!context_.footprint) {  // else the check has measured it
    result_.min_clearance_m =
        context_.space.clearance(driven, kClearanceReportedM) - context_.inflation.robot_radius_m;
  }
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

}  // namespace rovigo::planning
