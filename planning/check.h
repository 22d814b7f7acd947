#pragma once
// Judges a trajectory by its points alone. Shares no code with what made it.

#include <string>
#include <vector>

#include "maps/occupancy_grid.h"
#include "planning/footprint_check.h"
#include "planning/timing.h"
#include "planning/trajectory.h"

namespace rovigo::planning {

struct CheckOptions {
  double robot_radius_m = 0.30;
  FootprintSize footprint = {};  ///< not empty: checked instead of the circle
  MotionLimits limits = {};
  bool escape_allowed = false;      ///< may begin nearer to an obstacle than the radius
  bool unknown_is_blocked = true;   ///< map mode 0
  double clearance_looked_m = 0.6;  ///< clearances are measured up to this
};

/// What was found along the trajectory, in SI units; `problems` is empty when all of it is as
/// promised: free, within the limits, continuous, from rest to rest.
struct TrajectoryReport {
  double min_clearance_m = 0.0;    ///< centre to the nearest occupied cell's edge, after an escape
  std::size_t samples = 0;         ///< points looked at, at most 2 mm apart
  std::size_t unsafe_samples = 0;  ///< nearer than the radius, on blocked ground or off the map
  double max_speed_m_s = 0.0;
  double max_yaw_rate_rad_s = 0.0;
  double max_wheel_speed_m_s = 0.0;
  double max_acceleration_m_s2 = 0.0;
  double max_yaw_acceleration_rad_s2 = 0.0;
  double max_time_step_s = 0.0;
  double max_slip_m = 0.0;         ///< a step's displacement against speed times time
  double max_heading_slip = 0.0;   ///< rad, a step's turn against yaw rate times time
  double max_side_slip_rad = 0.0;  ///< direction of motion against heading, where it moves
  std::vector<std::string> problems;
};

TrajectoryReport check(const Trajectory& trajectory, const maps::OccupancyGrid& grid,
                       const CheckOptions& options);

}  // namespace rovigo::planning
