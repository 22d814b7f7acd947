#pragma once
// From two poses on a grid to a timed trajectory: search, smooth, time, check.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "maps/inflation.h"
#include "maps/occupancy_grid.h"
#include "maps/robot_model.h"
#include "planning/path.h"
#include "planning/plan_status.h"
#include "planning/planner_config.h"
#include "planning/trajectory.h"

namespace rovigo::planning {

/// Stages of one query, in order; libraries read no clock, so whoever wants times stamps these.
enum class PlanStage { kSearch, kSmooth, kTime, kDone };

/// In which order via points are visited.
enum class ViaOrder {
  kGiven,
  kShortest,  ///< by the lengths of the ways between them; see tour.h
};

struct PlanRequest {
  TPose2D start;
  bool start_heading_given = false;  ///< false: the rover is taken to face along the path
  std::vector<TPoint2D> via;
  ViaOrder via_order = ViaOrder::kGiven;
  TPose2D goal;
  bool goal_heading_given = false;               ///< true: a final turn in place to goal.phi
  std::uint64_t seed = 1;                        ///< sampling planners only
  std::function<void(PlanStage)> on_stage = {};  ///< called as each stage begins; may be empty
};

struct PlanResult {
  PlanStatus status = PlanStatus::kNoPath;
  std::string message;  ///< one sentence for people: what, where, the limit, the way out
  std::optional<TPoint2D> offending_point;
  std::optional<TPoint2D> nearest_reachable_goal;  ///< of a refused goal, when there is one
  Path grid_path;                                  ///< what the search found, cell centres
  Path smooth_path;                                ///< what is driven
  Trajectory trajectory;
  double search_length_m = 0.0;
  double path_length_m = 0.0;
  double min_clearance_m = 0.0;  ///< footprint circle to the nearest occupied cell's edge
  std::size_t expanded_cells = 0;
  std::vector<std::size_t> via_order;  ///< indices into the request's via, as they are visited
  /// Reference splines only: points at most 2 mm apart that are nearer to an obstacle than
  /// robot_radius_m or on blocked ground; the message says so when there are any.
  std::size_t unsafe_samples = 0;
  bool escape = false;  ///< started nearer to an obstacle than robot_radius_m; leaves it slowly
};

/// Plans on one grid. Inflates once, then answers many queries; plan() may be called from several
/// threads at once, and the answer depends on nothing but the arguments.
class Planner {
 public:
  /// Throws maps::InputError for settings out of range. The grid is copied.
  Planner(const maps::OccupancyGrid& grid, const maps::RobotModel& robot,
          const maps::InflationConfig& inflation, const PlannerConfig& config);
  /// The same on a costmap of the caller's: its impassable cells are closed, its soft costs count.
  Planner(const maps::OccupancyGrid& grid, const maps::Costmap& costmap,
          const maps::RobotModel& robot, const maps::InflationConfig& inflation,
          const PlannerConfig& config);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Nearer to an occupied cell's edge than inflation.robot_radius_m never happens on the result,
  /// except on an escape segment, which never touches occupied cells; where a straight way out
  /// exists it never gets nearer to them than the start was, else by less than a cell.
  PlanResult plan(const PlanRequest& request) const;

  const maps::Costmap& costmap() const;
  const maps::OccupancyGrid& grid() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Answer to `rovigo plan --point`.
struct PointQueryResult {
  PlanStatus status = PlanStatus::kNoPath;
  std::string message;
  std::optional<TPoint2D> offending_point;
  std::optional<TPoint2D> nearest_reachable_goal;
  Path path;  ///< cell centres, first the start's cell, last the goal's
  double length_m = 0.0;
  std::size_t expanded_cells = 0;
};

/// A point on the raw grid: 8 neighbours, no corner cutting, cost 1 and sqrt 2 times the resolution
/// between cell centres, no inflation, no smoothing; exact. Prepares once, answers many; not to be
/// shared between threads (query() reuses its workspace).
class PointPlanner {
 public:
  PointPlanner(const maps::OccupancyGrid& grid, maps::MapMode map_mode);
  ~PointPlanner();
  PointPlanner(PointPlanner&&) noexcept;
  PointPlanner& operator=(PointPlanner&&) noexcept;

  PointQueryResult query(const TPoint2D& start, const TPoint2D& goal);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One such query.
PointQueryResult plan_point(const maps::OccupancyGrid& grid, const TPoint2D& start,
                            const TPoint2D& goal,
                            maps::MapMode map_mode = maps::MapMode::kKnownFree);

}  // namespace rovigo::planning
