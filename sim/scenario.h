#pragma once
// What a scenario file changes: sensor noise, faults, disturbances. Defaults: design.md's figures.
// sim/scenarios/default.yaml shows every key with its meaning.

#include <filesystem>
#include <string>
#include <vector>

#include "maps/settings.h"

namespace rovigo::sim {

/// RGB-D camera after an active stereo sensor: errors live in disparity, hence grow as z^2.
struct CameraNoise {
  double depth_sigma_per_m = 0.0022;   ///< sigma = this * z^2 (1/m)
  double disparity_quantum_px = 0.08;  ///< 0: not quantised
  double baseline_m = 0.095;
  double min_range_m = 0.3;
  double max_range_m = 6.0;
  double max_incidence_deg = 80.0;  ///< more grazing than this: no return
  double edge_raggedness_px = 1.0;  ///< how far a depth edge may be torn, 0 .. 3
  double color_noise_levels = 2.5;  ///< sigma, in steps of 1/255
  double exposure_s = 0.008;        ///< what turning blurs
  bool auto_exposure = true;
  double auto_exposure_time_s = 0.4;
  double target_brightness = 0.42;  ///< mean that auto exposure aims at, 0 .. 1
  void describe(maps::SettingsVisitor& v);
};

/// A polished floor: it mirrors, and that deceives the depth camera where the view is shallow.
struct FloorGloss {
  double mirror = 0.0;               ///< 0 matt .. 1 as still water (Fresnel's law, scaled)
  double virtual_depth_share = 0.3;  ///< of shallow pixels, in patches: depth of the mirror image
  double dropout_share = 0.3;        ///< of shallow pixels, in patches: no return
  double depth_noise_m = 0.04;       ///< slow waves of the depth elsewhere
  void describe(maps::SettingsVisitor& v);
};

/// People who walk about near the rover; they never come near it, and are in no grid.
struct PeopleSettings {
  int count = 0;
  double min_speed_m_s = 0.6;
  double max_speed_m_s = 1.2;
  double reach_m = 3.5;  ///< they walk to places up to this far from the rover
  void describe(maps::SettingsVisitor& v);
};

struct ImuNoise {
  double rate_hz = 100.0;
  double gyro_sigma_rad_s = 0.003;
  double gyro_bias_max_rad_s = 0.01;  ///< each axis drawn by seed within +- this
  double gyro_walk_rad_s_per_sqrt_s = 1e-4;
  double accelerometer_sigma_m_s2 = 0.02;
  double accelerometer_bias_max_m_s2 = 0.1;
  void describe(maps::SettingsVisitor& v);
};

struct WheelNoise {
  double rate_hz = 48.0;
  double scale_error_max = 0.02;  ///< of speed, drawn by seed within +- this
  double track_error_max = 0.03;  ///< of turn rate, likewise
  int ticks_per_turn = 878;
  double slip_events_per_minute = 1.0;
  double slip_min = 0.2;  ///< share of one side's motion that is lost
  double slip_max = 0.5;
  double slip_max_duration_s = 0.8;
  void describe(maps::SettingsVisitor& v);
};

/// How the motors, whose speed and torque are the robot's (maps::RobotModel), are driven.
struct MotorModel {
  double lag_s = 0.04;          ///< first-order lag of the wheel speed loop
  double dead_zone_m_s = 0.04;  ///< a wheel at rest needs more than this to start
  double friction_nm = 0.05;    ///< of each wheel's bearings and gears
  double voltage_share = 1.0;   ///< of the battery's nominal voltage: scales speed and torque
  void describe(maps::SettingsVisitor& v);
};

/// The way of commands to the motors, as packets.
struct CommandLinkModel {
  double rate_hz = 120.0;
  double latency_s = 0.0;   ///< mean age of a command when it arrives
  double jitter_s = 0.0;    ///< the age varies uniformly by +- this
  double drop_share = 0.0;  ///< of the packets, lost; the motors hold the last one that came
  void describe(maps::SettingsVisitor& v);
};

/// What the rover carries, as a point mass.
struct Payload {
  double mass_kg = 0.0;
  double forward_m = 0.0;  ///< of base_link
  double left_m = 0.0;
  double up_m = 0.25;  ///< above the floor
  void describe(maps::SettingsVisitor& v);
};

/// The whole floor as one inclined plane.
struct Slope {
  double angle_deg = 0.0;
  double uphill_deg = 0.0;  ///< direction in the world, from its x axis
  void describe(maps::SettingsVisitor& v);
};

/// Slippery patches of the floor, placed by the seed.
struct FloorGrip {
  double slippery_share = 0.0;  ///< of the floor
  double patch_m = 0.4;         ///< side of a patch
  double slippery_grip = 0.4;   ///< share of the tyres' friction that is left there
  void describe(maps::SettingsVisitor& v);
};

/// For `--pose perturbed`: the truth as an estimator might deliver it. Applied by app.
struct PoseNoise {
  double rate_hz = 30.0;
  double sigma_position_m = 0.01;
  double sigma_heading_rad = 0.01;
  double latency_s = 0.05;
  double jitter_s = 0.01;
  double drop_share = 0.0;  ///< of the poses, lost
  void describe(maps::SettingsVisitor& v);
};

/// From `time_s` on all light is multiplied by `factor`.
struct LightStep {
  double time_s = 0.0;
  double factor = 1.0;
  void describe(maps::SettingsVisitor& v);
};

/// The camera delivers nothing (or, covered, black frames without depth) for a while.
struct Blackout {
  double start_s = 0.0;
  double duration_s = 0.0;
  std::string kind = "missing";  ///< "missing" or "covered"
  void describe(maps::SettingsVisitor& v);
};

/// Somebody carries the rover away and puts it down elsewhere.
struct Kidnap {
  double time_s = 0.0;
  double forward_m = 4.0;  ///< asked displacement, seen from where it was
  double left_m = 0.0;
  double turn_deg = 120.0;
  double carry_s = 0.0;  ///< 0: it stands there the next moment, and no sensor felt a thing
  /// What the IMU makes of the ride: "carried" (it feels it), "unfelt" (rest), or "switched_off"
  /// (IMU and wheels are silent).
  std::string kind = "carried";
  std::string camera = "missing";  ///< meanwhile: "missing" frames, or "covered" ones
  /// "free": the free spot nearest to the asked one that can be driven to; "driven": of the places
  /// it came through before, one about as far away as asked.
  std::string where = "free";
  void describe(maps::SettingsVisitor& v);
};

/// Something breaks in the closed loop for a while. The simulator applies what concerns the rover,
/// app what concerns observations, poses and commands.
struct Fault {
  /// "poses_stall": none arrives. "poses_late": they arrive `delay_s` later. "poses_not_finite":
  /// they are no numbers. "sensors_stall", "sensors_late": the same of all that the sensors tell,
  /// for poses that are made of it; "camera_late": of frames alone (a Blackout is their stall).
  /// "set_points_stop": the controller is dead. "battery_low": the voltage falls to `voltage_share`
  /// of the nominal one. "manual_takeover": an operator takes the rover.
  std::string kind = "poses_stall";
  double start_s = 0.0;
  double within_s = 0.0;  ///< it begins at a moment up to this later, drawn by the seed
  double duration_s = kForGood;
  double delay_s = 2.0;
  double voltage_share = 0.8;
  static constexpr double kForGood = 1e5;
  void describe(maps::SettingsVisitor& v);
};

/// Times are seconds since the recording's first moment.
struct Scenario {
  std::string name = "default";
  CameraNoise camera;
  FloorGloss floor;
  PeopleSettings people;
  ImuNoise imu;
  WheelNoise wheels;
  MotorModel motor;
  CommandLinkModel commands;
  Payload payload;
  Slope slope;
  FloorGrip grip;
  PoseNoise pose;
  std::vector<LightStep> light_steps;
  std::vector<Blackout> blackouts;
  std::vector<Kidnap> kidnaps;
  std::vector<Fault> faults;
};

/// Throws InputError naming file, line, key, value and limit.
Scenario load_scenario(const std::filesystem::path& file);

/// The same from text; `file` is used in messages only.
Scenario parse_scenario(const std::string& yaml, const std::string& file);

/// The default scenario without any noise, slip or fault.
Scenario ideal_scenario();

}  // namespace rovigo::sim
