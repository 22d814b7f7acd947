#include "control/docking_config.h"

namespace rovigo::control {
namespace {

void describe_dock(DockingConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "marker_side_m",
          .help = "Side of the marker's black square; a wrong one makes every distance wrong by as "
                  "much.",
          .min = 0.02,
          .max = 2.0,
          .advanced = false},
         c.marker_side_m);
  v.real({.name = "standoff_m",
          .help = "Where the rover's middle is to stop, from the marker's face; the camera must "
                  "still see the whole marker there.",
          .min = 0.25,
          .max = 5.0,
          .advanced = false},
         c.standoff_m);
}

void describe_along(DockingConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "kp_1_s",
          .help = "Proportional gain: speed per distance left to the dock.",
          .min = 0.05,
          .max = 5.0},
         c.kp_1_s);
  v.real({.name = "ki_1_s2",
          .help = "Integral gain, once the integrator is on.",
          .min = 0.0,
          .max = 5.0},
         c.ki_1_s2);
  v.real(
      {.name = "box_m",
       .help = "The integrator is switched on nearer than this to the dock (100: at once, a plain "
               "PI) ...",
       .min = 0.001,
       .max = 100.0},
      c.box_m);
  v.real({.name = "box_rate_m_s",
          .help = "... while it comes nearer by less than this per second (100: at any speed).",
          .min = 0.001,
          .max = 100.0},
         c.box_rate_m_s);
  v.real({.name = "max_speed_m_s",
          .help = "Highest speed asked for on the way; robot.max_speed_m_s holds as well.",
          .min = 0.05,
          .max = 0.8},
         c.max_speed_m_s);
  v.real({.name = "sample_time_s",
          .help = "Time between two samples of the PI, and between two camera frames.",
          .min = 0.02,
          .max = 0.5},
         c.sample_time_s);
}

void describe_across(DockingConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "approach_gain_1_m",
          .help = "Heading towards the dock's axis per metre beside it.",
          .min = 0.1,
          .max = 20.0},
         c.approach_gain_1_m);
  v.real({.name = "max_approach_angle_rad",
          .help = "Steepest heading towards the axis; the marker must stay in view.",
          .min = 0.05,
          .max = 1.2},
         c.max_approach_angle_rad);
  v.real(
      {.name = "heading_gain_1_s", .help = "Turn rate per heading error.", .min = 0.1, .max = 10.0},
      c.heading_gain_1_s);
  v.real({.name = "max_turn_rate_rad_s",
          .help = "Highest turn rate asked for.",
          .min = 0.1,
          .max = 3.0},
         c.max_turn_rate_rad_s);
  v.real({.name = "turn_first_angle_rad",
          .help = "Heading error beyond which the rover turns in place first.",
          .min = 0.05,
          .max = 1.5},
         c.turn_first_angle_rad);
}

void describe_end(DockingConfig& c, maps::SettingsVisitor& v) {
  v.real({.name = "along_tolerance_m",
          .help = "Distance left at which the rover stops; docked is within twice this.",
          .min = 0.001,
          .max = 0.2},
         c.along_tolerance_m);
  v.real({.name = "across_tolerance_m",
          .help = "Distance from the axis that counts as docked.",
          .min = 0.001,
          .max = 0.2},
         c.across_tolerance_m);
  v.real({.name = "heading_tolerance_rad",
          .help = "Heading error that counts as docked.",
          .min = 0.002,
          .max = 0.5},
         c.heading_tolerance_rad);
  v.real({.name = "back_up_m",
          .help = "Where it came in too far beside, the rover backs up this far from the dock.",
          .min = 0.2,
          .max = 3.0},
         c.back_up_m);
  v.real({.name = "back_up_speed_m_s", .help = "And so fast.", .min = 0.05, .max = 0.5},
         c.back_up_speed_m_s);
  v.integer({.name = "most_attempts",
             .help = "Attempts before the dock counts as missed.",
             .min = 1,
             .max = 50},
            c.most_attempts);
  v.real({.name = "longest_s",
          .help = "Docking is given up after this long.",
          .min = 1.0,
          .max = 3600.0},
         c.longest_s);
}

}  // namespace

void DockingConfig::describe(maps::SettingsVisitor& v) {
  describe_dock(*this, v);
  describe_along(*this, v);
  describe_across(*this, v);
  describe_end(*this, v);
}

}  // namespace rovigo::control
