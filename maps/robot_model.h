#pragma once
// The rover as everybody but the physics sees it: footprint, wheels, limits.

#include "maps/settings.h"

namespace rovigo::maps {

/// Defaults: Leo Rover (mission R). base_link is the middle of the wheel contacts, on the floor.
struct RobotModel {
  double footprint_length_m = 0.43;  ///< along x, centred on base_link
  double footprint_width_m = 0.41;   ///< along y, centred on base_link
  double body_height_m = 0.25;
  double robot_radius_m = 0.30;  ///< circumscribed radius of the footprint
  double wheel_radius_m = 0.0625;
  double track_width_m = 0.358;
  double wheel_base_m = 0.305;
  double max_speed_m_s = 0.4;
  double max_yaw_rate_rad_s = 1.0;
  double max_acceleration_m_s2 = 0.5;
  double max_yaw_acceleration_rad_s2 = 2.0;

  void describe(SettingsVisitor& v);
};

}  // namespace rovigo::maps
