#pragma once
#include "maps/settings.h"

namespace rovigo::control {

/// Settings of the trajectory tracker. One set serves 0.05 to 0.8 m/s: what depends on speed is
/// scheduled by speed, not tuned.
struct ControlConfig {
  // Heading loop: a first-order pull of the heading towards where it should point.
  double heading_kp_1_s = 4.0;
  double heading_ki_1_s2 = 1.5;
  // Speed loop: a first-order pull towards the reference's place along the path.
  double speed_kp_1_s = 1.8;
  double speed_ki_1_s2 = 0.4;
  double anti_windup_time_s = 0.5;

  // From cross-track error to heading: the path is approached at most at this angle.
  double cross_track_rate_1_s = 1.8;
  double cross_track_max_gain_1_m = 5.0;
  double max_approach_angle_rad = 0.7;
  double turn_first_angle_rad = 0.5235987755982988;  // 30 deg
  double turn_done_angle_rad = 0.05;
  double max_off_path_m = 0.5;

  // The reference waits for the rover: full pace up to the first lag, none from the second.
  double lag_slowdown_m = 0.04;
  double lag_stop_m = 0.15;

  // What is known of the drive.
  double drive_lag_s = 0.06;
  double command_delay_s = 0.0;
  double dead_zone_speed_m_s = 0.045;
  double max_wheel_speed_m_s = 0.9;
  bool adapt_turn_gain = true;

  // Trust in the pose (design.md, "Safety in motion").
  double watchdog_s = 0.2;
  double max_pose_age_s = 0.3;
  double doubtful_speed_m_s = 0.15;
  double max_doubtful_sigma_m = 0.10;
  double pose_noise_scale_m = 0.01;
  double pose_patience_s = 10.0;
  double takeover_patience_s = 60.0;

  // The end of the drive.
  double goal_tolerance_m = 0.03;
  double goal_heading_tolerance_rad = 0.05;
  double fine_tolerance_m = 0.003;
  double fine_heading_tolerance_rad = 0.01;
  double settle_time_s = 2.0;
  double stagnation_time_s = 6.0;
  double timeout_factor = 4.0;
  double timeout_extra_s = 30.0;

  void describe(maps::SettingsVisitor& v);
};

}  // namespace rovigo::control
