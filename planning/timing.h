#pragma once
// When the rover is where: speeds along curves under its limits, and turns in place between them.

#include <optional>
#include <vector>

#include "maps/robot_model.h"
#include "planning/planner_config.h"
#include "planning/smoother.h"
#include "planning/trajectory.h"

namespace rovigo::planning {

/// Limits that a timed trajectory keeps, SI units.
struct MotionLimits {
  double speed_m_s = 0.4;
  double yaw_rate_rad_s = 1.0;
  double acceleration_m_s2 = 0.4;
  double yaw_acceleration_rad_s2 = 1.6;
  double lateral_acceleration_m_s2 = 0.25;
  double wheel_speed_m_s = 0.8;  ///< at the rim, either wheel
  double track_width_m = 0.358;
};
MotionLimits limits_of(const maps::RobotModel& robot, const TimingConfig& config);

struct TimingProblem {
  std::vector<PathPiece> pieces;            ///< may be empty: then the rover only turns, at `at`
  TPoint2D at;                              ///< position when there are no pieces
  std::optional<double> start_heading_rad;  ///< turns in place to the first piece if it differs
  std::optional<double> goal_heading_rad;   ///< turns in place after the last piece
};

/// Time-optimal within each curve for limits on speed, turn rate, wheel speed and lateral
/// acceleration; the yaw acceleration is shared equally between the change of curvature and the
/// change of speed, which makes the usual forward-backward pass exact (Verscheure et al. 2009
/// discuss the full problem). Every piece begins and ends at rest.
Trajectory time_path(const TimingProblem& problem, const MotionLimits& limits,
                     const TimingConfig& config);

}  // namespace rovigo::planning
