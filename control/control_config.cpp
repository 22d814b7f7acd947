#include "control/control_config.h"

namespace rovigo::control {
namespace {

void describe_loops(ControlConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "heading_kp_1_s",
          .help = "Proportional gain of the heading loop: turn rate per heading error.",
          .min = 0.1,
          .max = 20.0},
         c.heading_kp_1_s);
  v.real({.name = "heading_ki_1_s2",
          .help = "Integral gain of the heading loop.",
          .min = 0.0,
          .max = 20.0},
         c.heading_ki_1_s2);
  v.real({.name = "speed_kp_1_s",
          .help = "Proportional gain of the speed loop: speed per distance behind the reference.",
          .min = 0.1,
          .max = 10.0},
         c.speed_kp_1_s);
  v.real({.name = "speed_ki_1_s2",
          .help = "Integral gain of the speed loop.",
          .min = 0.0,
          .max = 10.0},
         c.speed_ki_1_s2);
  v.real({.name = "anti_windup_time_s",
          .help = "How fast an integrator gives way while its output is at a limit.",
          .min = 0.01,
          .max = 10.0},
         c.anti_windup_time_s);
}

void describe_steering(ControlConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "cross_track_rate_1_s",
          .help = "How fast a cross-track error is driven to zero where speed allows it.",
          .min = 0.1,
          .max = 5.0},
         c.cross_track_rate_1_s);
  v.real(
      {.name = "cross_track_max_gain_1_m",
       .help = "Highest heading correction per metre of cross-track error, reached at low speed.",
       .min = 0.1,
       .max = 20.0},
      c.cross_track_max_gain_1_m);
  v.real({.name = "max_approach_angle_rad",
          .help = "Steepest angle at which the rover returns to its path.",
          .min = 0.05,
          .max = 1.4},
         c.max_approach_angle_rad);
  v.real({.name = "turn_first_angle_rad",
          .help = "Heading error beyond which the rover stops and turns in place first.",
          .min = 0.1,
          .max = 3.0},
         c.turn_first_angle_rad);
  v.real({.name = "turn_done_angle_rad",
          .help = "Heading error at which a turn in place gives way to driving again.",
          .min = 0.005,
          .max = 0.5},
         c.turn_done_angle_rad);
  v.real({.name = "max_off_path_m",
          .help = "Distance from the path beyond which the rover stands: nobody checked the ground "
                  "there.",
          .min = 0.05,
          .max = 10.0},
         c.max_off_path_m);
  v.real({.name = "lag_slowdown_m",
          .help = "Distance behind the reference from which the reference slows down and waits.",
          .min = 0.005,
          .max = 1.0},
         c.lag_slowdown_m);
  v.real({.name = "lag_stop_m",
          .help = "Distance behind the reference at which the reference stands still.",
          .min = 0.01,
          .max = 2.0},
         c.lag_stop_m);
}

void describe_drive(ControlConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "drive_lag_s",
          .help = "Time constant with which the drive follows a command.",
          .min = 0.0,
          .max = 1.0},
         c.drive_lag_s);
  v.real({.name = "command_delay_s",
          .help = "Dead time between a command and the drive.",
          .min = 0.0,
          .max = 0.5},
         c.command_delay_s);
  v.real({.name = "dead_zone_speed_m_s",
          .help = "Wheel speed that surely starts a standing rover; smaller commands are raised "
                  "to it (0: no compensation).",
          .min = 0.0,
          .max = 0.2},
         c.dead_zone_speed_m_s);
  v.real({.name = "max_wheel_speed_m_s",
          .help = "Highest speed at a wheel's rim; curves are slowed down to keep it.",
          .min = 0.1,
          .max = 3.0},
         c.max_wheel_speed_m_s);
  v.flag({.name = "adapt_turn_gain",
          .help = "Learn while driving how much of a commanded turn the wheels' scrubbing eats."},
         c.adapt_turn_gain);
}

void describe_trust(ControlConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "watchdog_s",
          .help = "The command is zero this long after the last usable pose or set-point arrived.",
          .min = 0.02,
          .max = 1.0},
         c.watchdog_s);
  v.real({.name = "max_pose_age_s",
          .help = "A pose older than this is not usable.",
          .min = 0.02,
          .max = 1.0},
         c.max_pose_age_s);
  v.real({.name = "doubtful_speed_m_s",
          .help = "Highest speed while the pose is doubtful.",
          .min = 0.0,
          .max = 0.8},
         c.doubtful_speed_m_s);
  v.real({.name = "max_doubtful_sigma_m",
          .help = "1-sigma position error of a doubtful pose beyond which the rover stops.",
          .min = 0.001,
          .max = 1.0},
         c.max_doubtful_sigma_m);
  v.real({.name = "pose_noise_scale_m",
          .help = "Stated 1-sigma position error at which a pose counts half against the "
                  "prediction.",
          .min = 0.001,
          .max = 1.0},
         c.pose_noise_scale_m);
  v.real({.name = "pose_patience_s",
          .help = "How long to wait, standing, for a usable pose, a set-point or a better battery "
                  "before giving up.",
          .min = 0.5,
          .max = 600.0},
         c.pose_patience_s);
  v.real({.name = "takeover_patience_s",
          .help = "How long an operator may hold the rover before the drive is given up.",
          .min = 0.5,
          .max = 3600.0},
         c.takeover_patience_s);
}

void describe_end(ControlConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "goal_tolerance_m",
          .help = "Distance from the goal that counts as reached.",
          .min = 0.005,
          .max = 0.5,
          .advanced = false},
         c.goal_tolerance_m);
  v.real({.name = "goal_heading_tolerance_rad",
          .help = "Heading error that counts as reached.",
          .min = 0.005,
          .max = 1.0},
         c.goal_heading_tolerance_rad);
  v.real({.name = "fine_tolerance_m",
          .help = "Distance from a stop that is aimed for while it can be had without reversing.",
          .min = 0.0005,
          .max = 0.1},
         c.fine_tolerance_m);
  v.real({.name = "fine_heading_tolerance_rad",
          .help = "Heading error aimed for at the end of a turn in place.",
          .min = 0.001,
          .max = 0.2},
         c.fine_heading_tolerance_rad);
  v.real({.name = "settle_time_s",
          .help = "Longest time spent at a stop on reaching the fine tolerances.",
          .min = 0.1,
          .max = 20.0},
         c.settle_time_s);
  v.real({.name = "stagnation_time_s",
          .help = "Time without progress after which the drive is given up.",
          .min = 1.0,
          .max = 120.0},
         c.stagnation_time_s);
  v.real({.name = "timeout_factor",
          .help = "The drive is given up after this multiple of the planned duration, plus "
                  "timeout_extra_s.",
          .min = 1.0,
          .max = 100.0},
         c.timeout_factor);
  v.real({.name = "timeout_extra_s",
          .help = "Time granted on top of timeout_factor times the planned duration.",
          .min = 0.0,
          .max = 3600.0},
         c.timeout_extra_s);
}

}  // namespace

void ControlConfig::describe(maps::SettingsVisitor& v) {
  describe_loops(*this, v);
  describe_steering(*this, v);
  describe_drive(*this, v);
  describe_trust(*this, v);
  describe_end(*this, v);
}

}  // namespace rovigo::control
