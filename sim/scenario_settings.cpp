// The keys of a scenario file: name, meaning and range of each.

#include "sim/scenario.h"

namespace rovigo::sim {

void CameraNoise::describe(maps::SettingsVisitor& v) {
  v.real({.name = "depth_sigma_per_m",
          .help = "Depth sigma is this times depth squared.",
          .min = 0,
          .max = 0.1},
         depth_sigma_per_m);
  v.real({.name = "disparity_quantum_px",
          .help = "Step of the disparity; 0 for none.",
          .min = 0,
          .max = 2},
         disparity_quantum_px);
  v.real({.name = "baseline_m", .help = "Between the two depth imagers.", .min = 0.01, .max = 0.5},
         baseline_m);
  v.real({.name = "min_range_m", .help = "Nearer than this: no return.", .min = 0, .max = 5},
         min_range_m);
  v.real({.name = "max_range_m", .help = "Farther than this: no return.", .min = 0.5, .max = 50},
         max_range_m);
  v.real({.name = "max_incidence_deg",
          .help = "More grazing than this: no return.",
          .min = 10,
          .max = 90},
         max_incidence_deg);
  v.real(
      {.name = "edge_raggedness_px", .help = "How far depth edges are torn.", .min = 0, .max = 3},
      edge_raggedness_px);
  v.real({.name = "color_noise_levels",
          .help = "Sigma of the colour noise in steps of 1/255.",
          .min = 0,
          .max = 50},
         color_noise_levels);
  v.real({.name = "exposure_s",
          .help = "Exposure time; turning blurs the image during it.",
          .min = 0,
          .max = 0.05},
         exposure_s);
  v.flag({.name = "auto_exposure", .help = "Whether the camera adapts to the light."},
         auto_exposure);
  v.real({.name = "auto_exposure_time_s",
          .help = "Time constant of the adaptation.",
          .min = 0.01,
          .max = 60},
         auto_exposure_time_s);
  v.real({.name = "target_brightness",
          .help = "Mean brightness the adaptation aims at.",
          .min = 0.05,
          .max = 0.95},
         target_brightness);
}

void FloorGloss::describe(maps::SettingsVisitor& v) {
  v.real({.name = "mirror", .help = "How strongly the floor mirrors.", .min = 0, .max = 1}, mirror);
  v.real({.name = "virtual_depth_share",
          .help = "Share of shallow floor pixels that read the mirror image's depth.",
          .min = 0,
          .max = 1},
         virtual_depth_share);
  v.real({.name = "dropout_share",
          .help = "Share of shallow floor pixels without return.",
          .min = 0,
          .max = 1},
         dropout_share);
  v.real({.name = "depth_noise_m", .help = "Waves of the other pixels.", .min = 0, .max = 0.5},
         depth_noise_m);
}

void PeopleSettings::describe(maps::SettingsVisitor& v) {
  v.integer({.name = "count", .help = "How many walk about.", .min = 0, .max = 10}, count);
  v.real({.name = "min_speed_m_s", .help = "Slowest walk.", .min = 0.1, .max = 3}, min_speed_m_s);
  v.real({.name = "max_speed_m_s", .help = "Fastest walk.", .min = 0.1, .max = 3}, max_speed_m_s);
  v.real({.name = "reach_m",
          .help = "They walk to places up to this far from the rover.",
          .min = 1.5,
          .max = 10},
         reach_m);
}

void ImuNoise::describe(maps::SettingsVisitor& v) {
  v.real({.name = "rate_hz", .help = "Samples a second.", .min = 1, .max = 240}, rate_hz);
  v.real({.name = "gyro_sigma_rad_s", .help = "White noise of each sample.", .min = 0, .max = 1},
         gyro_sigma_rad_s);
  v.real({.name = "gyro_bias_max_rad_s",
          .help = "Each axis' bias is drawn within +- this.",
          .min = 0,
          .max = 1},
         gyro_bias_max_rad_s);
  v.real({.name = "gyro_walk_rad_s_per_sqrt_s",
          .help = "Random walk of the gyro's bias.",
          .min = 0,
          .max = 0.1},
         gyro_walk_rad_s_per_sqrt_s);
  v.real({.name = "accelerometer_sigma_m_s2",
          .help = "White noise of each sample.",
          .min = 0,
          .max = 10},
         accelerometer_sigma_m_s2);
  v.real({.name = "accelerometer_bias_max_m_s2",
          .help = "Each axis' bias is drawn within +- this.",
          .min = 0,
          .max = 5},
         accelerometer_bias_max_m_s2);
}

void WheelNoise::describe(maps::SettingsVisitor& v) {
  v.real({.name = "rate_hz", .help = "Samples a second.", .min = 1, .max = 240}, rate_hz);
  v.real({.name = "scale_error_max",
          .help = "Share by which speed may be wrong, drawn by seed.",
          .min = 0,
          .max = 0.5},
         scale_error_max);
  v.real({.name = "track_error_max",
          .help = "Share by which turn rate may be wrong, by seed.",
          .min = 0,
          .max = 0.5},
         track_error_max);
  v.integer({.name = "ticks_per_turn",
             .help = "Encoder ticks in one turn of a wheel.",
             .min = 8,
             .max = 1000000},
            ticks_per_turn);
  v.real({.name = "slip_events_per_minute",
          .help = "How often one side's wheels lose grip.",
          .min = 0,
          .max = 60},
         slip_events_per_minute);
  v.real(
      {.name = "slip_min", .help = "Least share of motion lost in a slip.", .min = 0, .max = 0.9},
      slip_min);
  v.real(
      {.name = "slip_max", .help = "Largest share of motion lost in a slip.", .min = 0, .max = 0.9},
      slip_max);
  v.real({.name = "slip_max_duration_s", .help = "Longest slip.", .min = 0, .max = 10},
         slip_max_duration_s);
}

void MotorModel::describe(maps::SettingsVisitor& v) {
  v.real({.name = "lag_s", .help = "Time constant of the wheel speed loop.", .min = 0, .max = 1},
         lag_s);
  v.real({.name = "dead_zone_m_s",
          .help = "A wheel at rest needs more than this to start.",
          .min = 0,
          .max = 0.5},
         dead_zone_m_s);
  v.real({.name = "friction_nm",
          .help = "Friction of each wheel's bearings and gears.",
          .min = 0,
          .max = 10},
         friction_nm);
  v.real({.name = "voltage_share",
          .help = "Battery voltage as a share of the nominal one; scales the motors' speed and "
                  "torque.",
          .min = 0,
          .max = 1.2},
         voltage_share);
}

void CommandLinkModel::describe(maps::SettingsVisitor& v) {
  v.real({.name = "rate_hz", .help = "Commands a second.", .min = 2, .max = 240}, rate_hz);
  v.real(
      {.name = "latency_s", .help = "Mean age of a command when it arrives.", .min = 0, .max = 2},
      latency_s);
  v.real({.name = "jitter_s", .help = "The age varies uniformly by +- this.", .min = 0, .max = 1},
         jitter_s);
  v.real(
      {.name = "drop_share", .help = "Share of the commands that is lost.", .min = 0, .max = 0.95},
      drop_share);
}

void Payload::describe(maps::SettingsVisitor& v) {
  v.real({.name = "mass_kg", .help = "What the rover carries.", .min = 0, .max = 50}, mass_kg);
  v.real(
      {.name = "forward_m", .help = "Where it lies, ahead of the middle.", .min = -0.5, .max = 0.5},
      forward_m);
  v.real({.name = "left_m", .help = "Where it lies, left of the middle.", .min = -0.5, .max = 0.5},
         left_m);
  v.real({.name = "up_m", .help = "Where it lies, above the floor.", .min = 0, .max = 1}, up_m);
}

void Slope::describe(maps::SettingsVisitor& v) {
  v.real({.name = "angle_deg", .help = "How steep the floor is.", .min = 0, .max = 10}, angle_deg);
  v.real({.name = "uphill_deg",
          .help = "Where it rises, from the world's x axis, counter-clockwise.",
          .min = -360,
          .max = 360},
         uphill_deg);
}

void FloorGrip::describe(maps::SettingsVisitor& v) {
  v.real({.name = "slippery_share",
          .help = "Share of the floor that is slippery.",
          .min = 0,
          .max = 1},
         slippery_share);
  v.real({.name = "patch_m", .help = "Side of a slippery patch.", .min = 0.05, .max = 10}, patch_m);
  v.real({.name = "slippery_grip",
          .help = "Share of the tyres' friction that is left there.",
          .min = 0.01,
          .max = 1},
         slippery_grip);
}

void PoseNoise::describe(maps::SettingsVisitor& v) {
  v.real({.name = "rate_hz", .help = "Poses a second.", .min = 1, .max = 240}, rate_hz);
  v.real({.name = "sigma_position_m", .help = "White noise of x and y.", .min = 0, .max = 1},
         sigma_position_m);
  v.real({.name = "sigma_heading_rad", .help = "White noise of the heading.", .min = 0, .max = 1},
         sigma_heading_rad);
  v.real({.name = "latency_s", .help = "Mean age of a pose when it arrives.", .min = 0, .max = 3},
         latency_s);
  v.real({.name = "jitter_s", .help = "The age varies uniformly by +- this.", .min = 0, .max = 1},
         jitter_s);
  v.real({.name = "drop_share", .help = "Share of the poses that is lost.", .min = 0, .max = 0.95},
         drop_share);
}

void LightStep::describe(maps::SettingsVisitor& v) {
  v.real({.name = "time_s", .help = "When the light changes.", .min = 0, .max = 1e5}, time_s);
  v.real({.name = "factor",
          .help = "All light is multiplied by this from then on.",
          .min = 0,
          .max = 20},
         factor);
}

void Blackout::describe(maps::SettingsVisitor& v) {
  v.real({.name = "start_s", .help = "When it begins.", .min = 0, .max = 1e5}, start_s);
  v.real({.name = "duration_s", .help = "How long it lasts.", .min = 0, .max = 1e5}, duration_s);
  v.text({.name = "kind",
          .help = "No frames at all, or black ones.",
          .choices = {"missing", "covered"}},
         kind);
}

void Kidnap::describe(maps::SettingsVisitor& v) {
  v.real({.name = "time_s", .help = "When the rover is carried away.", .min = 0, .max = 1e5},
         time_s);
  v.real({.name = "forward_m", .help = "Where to, ahead of where it was.", .min = -100, .max = 100},
         forward_m);
  v.real({.name = "left_m", .help = "Where to, left of where it was.", .min = -100, .max = 100},
         left_m);
  v.real({.name = "turn_deg", .help = "By how much it is turned.", .min = -180, .max = 180},
         turn_deg);
  v.real({.name = "carry_s", .help = "How long the ride takes.", .min = 0, .max = 60}, carry_s);
  v.text({.name = "kind",
          .help = "Whether the IMU feels the ride, does not, or is silent as the wheels are.",
          .choices = {"carried", "unfelt", "switched_off"}},
         kind);
  v.text({.name = "camera",
          .help = "No frames during the ride, or black ones.",
          .choices = {"missing", "covered"}},
         camera);
  v.text({.name = "where",
          .help = "The free spot nearest to the asked one, or a place it drove through before.",
          .choices = {"free", "driven"}},
         where);
}

void Fault::describe(maps::SettingsVisitor& v) {
  v.text(
      {.name = "kind",
       .help = "What breaks.",
       .choices = {"poses_stall", "poses_late", "poses_not_finite", "sensors_stall", "sensors_late",
                   "camera_late", "set_points_stop", "battery_low", "manual_takeover"}},
      kind);
  v.real({.name = "start_s", .help = "When it begins.", .min = 0, .max = kForGood}, start_s);
  v.real({.name = "within_s",
          .help = "It begins up to this later, at a moment drawn by the seed.",
          .min = 0,
          .max = kForGood},
         within_s);
  v.real({.name = "duration_s",
          .help = "How long it lasts; left out: for good.",
          .min = 0,
          .max = kForGood},
         duration_s);
  v.real({.name = "delay_s", .help = "What comes late: by how much.", .min = 0, .max = 10},
         delay_s);
  v.real({.name = "voltage_share",
          .help = "battery_low: voltage as a share of the nominal one.",
          .min = 0,
          .max = 1},
         voltage_share);
}

}  // namespace rovigo::sim
