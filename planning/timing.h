#pragma once
// When the rover is where: speeds along curves under its limits, and turns in place between them.

#include <functional>
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
  /// Of a rover under way: along the first piece, which then must begin with its heading; or, at
  /// rest, turning in place at this rate. Zero for a rover at rest.
  double start_speed_m_s = 0.0;
  double start_yaw_rate_rad_s = 0.0;
  /// Metres to spare beyond the radius, for TimingConfig::slow_within_m; may be empty.
  std::function<double(const TPoint2D&)> room_m = {};
};

/// Time-optimal within each curve (see speed_profile.h) and each turn in place. Every piece ends at
/// rest and begins so, but for the start speed of the first. Empty when that speed is too high for
/// the curve: no braking keeps its limits.
Trajectory time_path(const TimingProblem& problem, const MotionLimits& limits,
                     const TimingConfig& config);

}  // namespace rovigo::planning
