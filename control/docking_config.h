#pragma once
#include "control/switching_pi.h"
#include "maps/settings.h"

namespace rovigo::control {

/// Settings of docking on a marker (mission F8). The PI's constants: framework thesis, table 4.1.
struct DockingConfig {
  // The dock.
  double marker_side_m = 0.18;
  double standoff_m = 0.6;

  // Along: the switching PI, from the distance left to the speed.
  double kp_1_s = 0.9;
  double ki_1_s2 = 0.3;
  double box_m = 0.2;
  double box_rate_m_s = 0.1;
  double max_speed_m_s = 0.5;
  double sample_time_s = 0.05;

  // Across: the heading steers to the dock's axis.
  double approach_gain_1_m = 3.0;
  double max_approach_angle_rad = 0.6;
  double heading_gain_1_s = 2.0;
  double max_turn_rate_rad_s = 0.8;
  double turn_first_angle_rad = 0.5;

  // The end.
  double along_tolerance_m = 0.008;
  double across_tolerance_m = 0.012;
  double heading_tolerance_rad = 0.012;
  double back_up_m = 0.9;
  double back_up_speed_m_s = 0.2;
  int most_attempts = 4;
  double longest_s = 90.0;

  SwitchingPiConfig along() const {
    return {kp_1_s, ki_1_s2, box_m, box_rate_m_s, max_speed_m_s, sample_time_s};
  }
  void describe(maps::SettingsVisitor& v);
};

}  // namespace rovigo::control
