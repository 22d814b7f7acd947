#pragma once
// What may be asked of the drive: speed, turn rate, rim speed, and how fast they change.

#include "control/control_config.h"
#include "maps/geometry.h"
#include "maps/robot_model.h"

namespace rovigo::control {

struct DriveLimits {
  double max_speed_m_s = 0.4;
  double max_reverse_speed_m_s = 0.0;  ///< trajectories are driven forwards only
  double max_yaw_rate_rad_s = 1.0;
  double max_wheel_speed_m_s = 0.9;
  double track_width_m = 0.358;
  double max_acceleration_m_s2 = 0.5;
  double max_yaw_acceleration_rad_s2 = 2.0;
};

DriveLimits drive_limits(const ControlConfig& config, const maps::RobotModel& robot);

/// `desired` made drivable: within every limit, and reachable from `last` within `dt_s`. Where both
/// cannot be had, turning comes before speed, so that the path is kept. Precondition: `last` is
/// within the limits. A desire that is not finite counts as standstill.
TTwist2D limited_command(const TTwist2D& desired, const TTwist2D& last, double dt_s,
                         const DriveLimits& limits);

/// Rim speed of the faster wheel, m/s.
double faster_wheel(const TTwist2D& twist, double track_width_m);

/// Breaks stiction: once the rover has stood for a moment (`standing_s`), a desire whose faster
/// wheel would stay within the dead zone is enlarged, keeping its curvature, until that wheel
/// starts. Desires below a tenth of it count as standstill. The moment keeps a drive with less
/// stiction than assumed from being pushed while it still rolls.
TTwist2D with_dead_zone_compensation(const TTwist2D& desired, double standing_s,
                                     double dead_zone_m_s, double track_width_m);

}  // namespace rovigo::control
