#include "maps/robot_model.h"

namespace rovigo::maps {

namespace {

void describe_body(RobotModel& r, SettingsVisitor& v) {
  v.real({.name = "mass_kg",
          .help = "Mass of the rover, wheels included; must exceed that of four wheels.",
          .min = 0.5,
          .max = 200.0},
         r.mass_kg);
  v.real({.name = "wheel_mass_kg", .help = "Mass of each wheel.", .min = 0.01, .max = 20.0},
         r.wheel_mass_kg);
  v.real({.name = "center_of_mass_height_m",
          .help = "Height of the body's centre of mass above the floor.",
          .min = 0.01,
          .max = 1.0},
         r.center_of_mass_height_m);
  v.real({.name = "ground_clearance_m",
          .help = "Height of the body's underside; the wheels roll over what is lower.",
          .min = 0.01,
          .max = 0.5},
         r.ground_clearance_m);
  v.real({.name = "tire_friction",
          .help = "Friction of the tyres where they roll.",
          .min = 0.05,
          .max = 2.0},
         r.tire_friction);
  v.real({.name = "tire_side_friction",
          .help = "Friction of the tyres along their axles.",
          .min = 0.05,
          .max = 2.0},
         r.tire_side_friction);
  v.real({.name = "tire_scrub_n_s_m",
          .help = "Side force of each tyre per speed of scrubbing, up to its side friction.",
          .min = 1.0,
          .max = 1000.0},
         r.tire_scrub_n_s_m);
}

void describe_motors(RobotModel& r, SettingsVisitor& v) {
  v.real({.name = "motor_no_load_speed_m_s",
          .help = "Speed at the wheel's rim at which a motor has no torque left.",
          .min = 0.1,
          .max = 10.0},
         r.motor_no_load_speed_m_s);
  v.real({.name = "motor_stall_torque_nm",
          .help = "Torque of each of the four motors at rest.",
          .min = 0.01,
          .max = 50.0},
         r.motor_stall_torque_nm);
  v.real({.name = "battery_nominal_v",
          .help = "Voltage at which the motors' speed and torque hold.",
          .min = 1.0,
          .max = 100.0},
         r.battery_nominal_v);
  v.real({.name = "battery_low_v",
          .help = "Battery voltage below which the drive side stops the rover (0: never).",
          .min = 0.0,
          .max = 100.0},
         r.battery_low_v);
}

}  // namespace

void RobotModel::describe(SettingsVisitor& v) {
  v.real({.name = "footprint_length_m",
          .help = "Length of the footprint along x.",
          .min = 0.05,
          .max = 2.0},
         footprint_length_m);
  v.real({.name = "footprint_width_m",
          .help = "Width of the footprint along y.",
          .min = 0.05,
          .max = 2.0},
         footprint_width_m);
  v.real({.name = "body_height_m",
          .help = "Height of the rover above the floor.",
          .min = 0.02,
          .max = 2.0},
         body_height_m);
  v.real({.name = "robot_radius_m",
          .help = "Radius of the circle around the footprint; nearer to an obstacle than this is "
                  "never planned.",
          .min = 0.0,
          .max = 2.0,
          .advanced = false},
         robot_radius_m);
  v.real({.name = "wheel_radius_m", .help = "Nominal wheel radius.", .min = 0.01, .max = 0.5},
         wheel_radius_m);
  v.real({.name = "track_width_m",
          .help = "Nominal distance between left and right wheels.",
          .min = 0.05,
          .max = 2.0},
         track_width_m);
  v.real({.name = "wheel_base_m",
          .help = "Distance between front and rear axles.",
          .min = 0.0,
          .max = 2.0},
         wheel_base_m);
  v.real({.name = "max_speed_m_s",
          .help = "Highest forward speed.",
          .min = 0.05,
          .max = 0.8,
          .advanced = false},
         max_speed_m_s);
  v.real({.name = "max_yaw_rate_rad_s",
          .help = "Highest turn rate.",
          .min = 0.05,
          .max = 3.0,
          .advanced = false},
         max_yaw_rate_rad_s);
  v.real({.name = "max_acceleration_m_s2",
          .help = "Highest linear acceleration.",
          .min = 0.05,
          .max = 5.0},
         max_acceleration_m_s2);
  v.real({.name = "max_yaw_acceleration_rad_s2",
          .help = "Highest angular acceleration.",
          .min = 0.1,
          .max = 20.0},
         max_yaw_acceleration_rad_s2);
  describe_body(*this, v);
  describe_motors(*this, v);
}

}  // namespace rovigo::maps
