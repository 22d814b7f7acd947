#include "maps/robot_model.h"

namespace rovigo::maps {

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
}

}  // namespace rovigo::maps
