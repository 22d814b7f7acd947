#pragma once
// Plans that are to be driven. A map errs by a few centimetres, a pose by another few, and what
// nobody has seen may hide a table's leg: drives stay off unseen ground with the whole rover, and
// keep a margin wherever the way allows.

#include <optional>
#include <string>
#include <vector>

#include "planning/planner.h"

namespace rovigo::planning {

/// Like Planner, but stricter:
/// - in map mode 0 unseen ground counts as an obstacle, with robot_radius_m around it, except where
///   a rover has been;
/// - cells nearer to an obstacle than robot_radius_m + drive_margin_m are closed; where start, goal
///   or the only way lie in them, just those that must be passed are opened;
/// - three quarters of drive_margin_m beside the rover's rectangle is kept in any case, but for the
/// start. drive_margin_m = 0, reference splines, map mode 2 and rectangle planning: Planner as it
/// is.
class DrivePlanner {
 public:
  /// `been`: where a rover has stood or driven. Throws maps::InputError for settings out of range.
  /// The grid is copied.
  DrivePlanner(const maps::OccupancyGrid& grid, const maps::RobotModel& robot,
               const maps::InflationConfig& inflation, const PlannerConfig& config,
               const std::vector<TPoint2D>& been = {});

  /// The message tells how much of the way leaves less than the margin.
  PlanResult plan(const PlanRequest& request) const;

  /// Unseen ground included, the margin not.
  const maps::Costmap& costmap() const { return strict_.costmap(); }

 private:
  struct Tight {
    TPoint2D at;
    double room_m = 0.0;  ///< between the rover's rectangle and the nearest obstacle
  };

  Planner with_costmap(const maps::Costmap& costmap, const PlannerConfig& config) const;
  maps::Costmap band_closed(const std::vector<bool>& opened) const;
  std::vector<bool> opened_along(const Path& way) const;
  Path roomiest_way(const PlanRequest& request) const;
  std::optional<Tight> too_tight(const PlanResult& result) const;
  PlanResult refuse_unseen(const PlanRequest& request, PlanResult refused) const;
  PlanResult refuse_tight(const PlanRequest& request, const Tight& tight) const;
  void tell_squeezes(PlanResult& result) const;

  maps::OccupancyGrid grid_;
  maps::RobotModel robot_;
  maps::InflationConfig inflation_;
  PlannerConfig config_;
  bool keeps_margin_;
  Planner strict_;          ///< with unseen ground as obstacles
  std::vector<bool> band_;  ///< passable, but within the margin; row-major as the grid
};

}  // namespace rovigo::planning
