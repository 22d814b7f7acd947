#pragma once
// How well a drive followed its plan, measured on the true poses of the log.

#include "control/drive_log.h"

namespace rovigo::control {

/// All errors are measured on truth. Cross-track is the distance to the planned geometry; its size
/// is averaged. Along-track is the distance, along the reference's heading, to the point the
/// tracker steered to at that moment (progress, not the clock).
struct DriveMetrics {
  double path_length_m = 0.0;    ///< of the plan
  double driven_length_m = 0.0;  ///< of the true poses
  double planned_duration_s = 0.0;
  double duration_s = 0.0;
  double cross_track_rms_m = 0.0;
  double cross_track_max_m = 0.0;
  double along_track_rms_m = 0.0;
  double along_track_max_m = 0.0;
  double heading_rms_rad = 0.0;  ///< true yaw against the reference's
  double heading_max_rad = 0.0;
  double final_position_error_m = 0.0;
  double final_heading_error_rad = 0.0;  ///< absolute; 0 when no goal heading was given
  double estimate_rms_m = 0.0;           ///< estimated against true position, where not lost
  double speed_rms_error_m_s = 0.0;      ///< true speed against commanded
  double saturation_share = 0.0;  ///< share of steps with a command at a speed or turn-rate limit
  double max_speed_m_s = 0.0;     ///< highest commanded speed
  double max_yaw_rate_rad_s = 0.0;
  bool goal_heading_given = false;
  double overshoot_m = 0.0;  ///< farthest beyond the goal, along the path's last direction
  /// From when the reference stands at the goal until the rover stays within 5 mm of where it ends.
  double settling_s = 0.0;
  /// Changes of turning direction within 2 cm of the goal, slower turns than 0.15 rad/s aside.
  int goal_reversals = 0;
  double jerk_rms_m_s3 = 0.0;  ///< of the commanded speed, averaged over tenths of a second
  double time_ratio = 0.0;     ///< duration by planned duration; 0 for a plan without duration
  /// Success weighted by path length (Anderson et al. 2018): planned by driven length, at most 1;
  /// 0 when the goal was not reached or something was touched.
  double spl = 0.0;
};

/// Speed and turn rate at which a command counts as saturated.
struct CommandLimits {
  double max_speed_m_s = 0.4;
  double max_yaw_rate_rad_s = 1.0;
};

/// An empty log gives the plan's figures and zeros otherwise.
DriveMetrics measure(const DriveLog& log, const planning::Trajectory& planned, const TPose2D& goal,
                     bool goal_heading_given, const CommandLimits& limits = {});

/// Signed distance from `point` to the trajectory's polyline, left of the direction of travel
/// positive. Precondition: the trajectory is not empty.
double cross_track_error_m(const planning::Trajectory& planned, const TPoint2D& point);

}  // namespace rovigo::control
