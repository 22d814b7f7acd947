#include "planning/drive_planner.h"

#include <algorithm>
#include <cmath>

#include "maps/distance_field.h"
#include "planning/footprint_check.h"
#include "planning/refusal.h"

namespace rovigo::planning {

namespace {

using maps::Cell;
using maps::Costmap;
using maps::OccupancyGrid;

/// A metre in the band counts as this many outside it when the least of it is looked for.
constexpr double kBandPrice = 30.0;
/// Around a cell that must be passed, others are opened too: the smoother needs some room.
constexpr double kOpenedRadiusM = 0.25;
/// Of the margin, what is kept in any case.
constexpr double kLeastShare = 0.75;

/// The grid with unseen ground as obstacles. Only where two cells by two are unknown: a gap between
/// the camera's rays hides nothing that stands on the floor. The camera does not see the floor
/// under the rover and beside it; where one has been there is nothing.
OccupancyGrid with_unseen_blocked(const OccupancyGrid& grid, const std::vector<TPoint2D>& been,
                                  double clear_m) {
  OccupancyGrid out = grid;
  const auto& g = grid.geometry;
  const maps::DistanceField to_been = maps::distance_to_points(g, been);
  for (int y = 0; y + 1 < g.height; ++y) {
    for (int x = 0; x + 1 < g.width; ++x) {
      const Cell block[] = {{x, y}, {x + 1, y}, {x, y + 1}, {x + 1, y + 1}};
      const bool whole = std::all_of(std::begin(block), std::end(block), [&](Cell c) {
        return OccupancyGrid::is_unknown(grid.at(c)) &&
               static_cast<double>(to_been.at(c)) > clear_m;
      });
      if (!whole) continue;
      for (const Cell c : block) out.at(c) = OccupancyGrid::kOccupied;
    }
  }
  return out;
}

/// So that what was driven once can be driven again, with the margin, a cell or so aside.
double clear_where_been_m(const OccupancyGrid& grid, const maps::InflationConfig& inflation,
                          const PlannerConfig& config) {
  return inflation.robot_radius_m + config.drive_margin_m + 2.0 * grid.geometry.resolution_m;
}

/// Passable cells with an obstacle nearer than `keep_m` to their centres.
std::vector<bool> band_of(const OccupancyGrid& grid, const Costmap& costmap, double keep_m) {
  const maps::DistanceField field = maps::distance_to_occupied(grid);
  std::vector<bool> band(field.meters.size());
  for (std::size_t i = 0; i < band.size(); ++i) {
    band[i] =
        Costmap::is_passable(costmap.cells[i]) && static_cast<double>(field.meters[i]) < keep_m;
  }
  return band;
}

bool margin_wanted(const maps::InflationConfig& inflation, const PlannerConfig& config) {
  return config.drive_margin_m > 0.0 && config.spline.mode == "safe" &&
         inflation.map_mode != maps::MapMode::kEverything && !plans_with_rectangle(config);
}

}  // namespace

DrivePlanner::DrivePlanner(const OccupancyGrid& grid, const maps::RobotModel& robot,
                           const maps::InflationConfig& inflation, const PlannerConfig& config,
                           const std::vector<TPoint2D>& been)
    : grid_(grid),
      robot_(robot),
      inflation_(inflation),
      config_(config),
      keeps_margin_(margin_wanted(inflation, config)),
      strict_(keeps_margin_ && inflation.map_mode == maps::MapMode::kKnownFree
                  ? with_unseen_blocked(grid, been, clear_where_been_m(grid, inflation, config))
                  : grid,
              robot, inflation, config) {
  if (!keeps_margin_) return;
  band_ =
      band_of(strict_.grid(), strict_.costmap(), inflation.robot_radius_m + config.drive_margin_m);
}

PlanResult DrivePlanner::plan(const PlanRequest& request) const {
  if (!keeps_margin_) return strict_.plan(request);
  const Costmap costmap = band_closed(opened_along(roomiest_way(request)));
  PlanResult result = with_costmap(costmap, config_).plan(request);
  // Refusals are worded, and their way out is found, by who knows the map without a margin.
  if (result.status != PlanStatus::kOk) result = strict_.plan(request);
  if (result.status != PlanStatus::kOk) return refuse_unseen(request, std::move(result));
  if (const auto tight = too_tight(result)) return refuse_tight(request, *tight);
  tell_squeezes(result);
  return result;
}

Planner DrivePlanner::with_costmap(const Costmap& costmap, const PlannerConfig& config) const {
  return {strict_.grid(), costmap, robot_, inflation_, config};
}

Costmap DrivePlanner::band_closed(const std::vector<bool>& opened) const {
  Costmap costmap = strict_.costmap();
  for (std::size_t i = 0; i < band_.size(); ++i) {
    if (band_[i] && !opened[i]) costmap.cells[i] = Costmap::kUnknown;
  }
  return costmap;
}

/// Of the ways that keep robot_radius_m, the one that runs least in the band; empty: there is none.
Path DrivePlanner::roomiest_way(const PlanRequest& request) const {
  Costmap priced = strict_.costmap();
  for (std::size_t i = 0; i < band_.size(); ++i) {
    if (Costmap::is_passable(priced.cells[i])) {
      priced.cells[i] = band_[i] ? Costmap::kMaxSoft : Costmap::kFree;
    }
  }
  PlannerConfig config = config_;
  config.planner = to_string(PlannerKind::kAStar);
  config.astar.soft_cost_weight = kBandPrice;
  config.astar.heuristic_weight = 1.0;
  config.spline.smooth = false;
  PlanRequest quiet = request;
  quiet.on_stage = {};
  return with_costmap(priced, config).plan(quiet).grid_path;
}

/// Cells around those of the way that lie in the band.
std::vector<bool> DrivePlanner::opened_along(const Path& way) const {
  const auto& g = grid_.geometry;
  std::vector<bool> opened(band_.size(), false);
  const int reach = static_cast<int>(std::ceil(kOpenedRadiusM / g.resolution_m));
  for (const TPoint2D& p : way.points) {
    const Cell at = g.cell_at(p);
    if (!band_[g.index_of(at)]) continue;
    for (int y = std::max(0, at.y - reach); y <= std::min(g.height - 1, at.y + reach); ++y) {
      for (int x = std::max(0, at.x - reach); x <= std::min(g.width - 1, at.x + reach); ++x) {
        opened[g.index_of({x, y})] = true;
      }
    }
  }
  return opened;
}

/// The first pose with less than that around the rover's rectangle. Where it stands at
/// the start it has to leave, however tight it is.
std::optional<DrivePlanner::Tight> DrivePlanner::too_tight(const PlanResult& result) const {
  const double least_m = kLeastShare * config_.drive_margin_m;
  const FootprintSize size{robot_.footprint_length_m, robot_.footprint_width_m};
  const auto& points = result.trajectory.points;
  const TPoint2D start = maps::position_of(points.front().pose);
  for (const auto& p : points) {
    const TPoint2D at = maps::position_of(p.pose);
    if (maps::distance(at, start) < robot_.robot_radius_m) continue;
    const double room_m = footprint_clearance(strict_.grid(), p.pose, size, least_m);
    if (room_m < least_m) return Tight{at, room_m};
  }
  return std::nullopt;
}

/// `refused` by the strict planner: because of what is there, or of what nobody has seen?
PlanResult DrivePlanner::refuse_unseen(const PlanRequest& request, PlanResult refused) const {
  if (inflation_.map_mode != maps::MapMode::kKnownFree) return refused;
  const PlanResult plain = Planner(grid_, robot_, inflation_, config_).plan(request);
  if (plain.status == PlanStatus::kOk) {
    refused.message = "The goal " + text_of(maps::position_of(request.goal)) +
                      " can be reached only over ground that nobody has seen or right beside it; "
                      "drives keep robot_radius_m = " +
                      meters(inflation_.robot_radius_m) + " from it." +
                      nearest_hint(refused.nearest_reachable_goal);
    return refused;
  }
  if (plain.status != refused.status) return refused;
  // What is wrong in plain words, but the way out as drives have it.
  refused.message = plain.message;
  const std::string hint = nearest_hint(plain.nearest_reachable_goal);
  if (refused.message.ends_with(hint)) refused.message.resize(refused.message.size() - hint.size());
  refused.message += nearest_hint(refused.nearest_reachable_goal);
  return refused;
}

PlanResult DrivePlanner::refuse_tight(const PlanRequest& request, const Tight& tight) const {
  // Where would it end with the whole margin? Only the start's surroundings stay open.
  const Path start{{maps::position_of(request.start)}};
  const bool on_map = grid_.geometry.contains(start.points.front());
  PlanResult result =
      with_costmap(band_closed(opened_along(on_map ? start : Path{})), config_).plan(request);
  if (result.status == PlanStatus::kOk) return result;
  result.offending_point = tight.at;
  result.message =
      "On the way to the goal " + text_of(maps::position_of(request.goal)) +
      " the rover's body would pass an obstacle or unseen ground by " + meters(tight.room_m) +
      " at " + text_of(tight.at) +
      "; map and pose err, so drives keep at least three quarters of drive_margin_m = " +
      meters(config_.drive_margin_m) + "." + nearest_hint(result.nearest_reachable_goal);
  return result;
}

void DrivePlanner::tell_squeezes(PlanResult& result) const {
  const auto& g = grid_.geometry;
  double squeezed_m = 0.0;
  const auto& points = result.trajectory.points;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const TPoint2D at = maps::position_of(points[i].pose);
    if (!band_[g.index_of(g.cell_at(at))]) continue;
    squeezed_m += maps::distance(maps::position_of(points[i - 1].pose), at);
  }
  if (squeezed_m < g.resolution_m) return;
  if (!result.message.empty()) result.message += " ";
  result.message += meters(squeezed_m) + " of the way leave less than drive_margin_m = " +
                    meters(config_.drive_margin_m) + " beside obstacles or unseen ground.";
}

}  // namespace rovigo::planning
