#pragma once
// The rover, once for everybody: footprint, wheels and limits for planning and control; masses,
// tyres, motors and battery for the simulator.

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

  double mass_kg = 6.5;  ///< wheels included
  double wheel_mass_kg = 0.3;
  double center_of_mass_height_m = 0.09;  ///< of the body without wheels, above the floor
  double ground_clearance_m = 0.03;       ///< lower things are rolled over
  double tire_friction = 0.9;             ///< where a tyre rolls
  double tire_side_friction = 0.75;       ///< along its axle
  double tire_scrub_n_s_m = 80.0;         ///< side force of each tyre per scrubbing speed
  double motor_no_load_speed_m_s = 1.0;   ///< at the rim, at the battery's nominal voltage
  double motor_stall_torque_nm = 2.0;     ///< of each of the four motors, likewise
  double battery_nominal_v = 11.1;
  double battery_low_v = 9.6;  ///< below it the drive side stops

  void describe(SettingsVisitor& v);
};

}  // namespace rovigo::maps
