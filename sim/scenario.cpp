#include "sim/scenario.h"

#include "sim/yaml_reader.h"

namespace rovigo::sim {

namespace {

constexpr std::size_t kMaxEvents = 1000;

template <class Config>
void read_section(const std::string& file, const YAML::Node& root, const char* name,
                  Config& config) {
  if (const YAML::Node node = root[name]) read_settings(file, node, config);
}

template <class Event>
void read_events(const std::string& file, const YAML::Node& root, const char* name,
                 std::vector<Event>& events) {
  const YAML::Node list = root[name];
  if (!list) return;
  if (!list.IsSequence()) fail_at(file, list, std::string(name) + " must be a list of events");
  if (list.size() > kMaxEvents) {
    fail_at(file, list,
            std::string(name) + " holds more than " + std::to_string(kMaxEvents) + " events");
  }
  for (const auto& node : list) read_settings(file, node, events.emplace_back());
}

void require_ordered(const std::string& file, const YAML::Node& root, const char* section,
                     const char* low_name, double low, const char* high_name, double high) {
  if (low <= high) return;
  fail_at(file, root[section],
          std::string(section) + ": " + low_name + " must not exceed " + high_name);
}

}  // namespace

Scenario parse_scenario(const std::string& yaml, const std::string& file) {
  const YAML::Node root = parse_yaml(yaml, file);
  require_known_keys(
      file, root,
      {"name", "camera", "floor", "people", "imu", "wheels", "motor", "commands", "payload",
       "slope", "grip", "pose", "light_steps", "blackouts", "kidnaps", "faults"});
  Scenario s;
  s.name = std::filesystem::path(file).stem().string();
  if (const YAML::Node name = root["name"]) {
    if (!name.IsScalar()) fail_at(file, name, "name must be a single value");
    s.name = name.Scalar();
  }
  read_section(file, root, "camera", s.camera);
  read_section(file, root, "floor", s.floor);
  read_section(file, root, "people", s.people);
  read_section(file, root, "imu", s.imu);
  read_section(file, root, "wheels", s.wheels);
  read_section(file, root, "motor", s.motor);
  read_section(file, root, "commands", s.commands);
  read_section(file, root, "payload", s.payload);
  read_section(file, root, "slope", s.slope);
  read_section(file, root, "grip", s.grip);
  read_section(file, root, "pose", s.pose);
  read_events(file, root, "light_steps", s.light_steps);
  read_events(file, root, "blackouts", s.blackouts);
  read_events(file, root, "kidnaps", s.kidnaps);
  read_events(file, root, "faults", s.faults);
  require_ordered(file, root, "camera", "min_range_m", s.camera.min_range_m, "max_range_m",
                  s.camera.max_range_m);
  require_ordered(file, root, "people", "min_speed_m_s", s.people.min_speed_m_s, "max_speed_m_s",
                  s.people.max_speed_m_s);
  require_ordered(file, root, "wheels", "slip_min", s.wheels.slip_min, "slip_max",
                  s.wheels.slip_max);
  return s;
}

Scenario load_scenario(const std::filesystem::path& file) {
  return parse_scenario(read_text(file), file.string());
}

Scenario ideal_scenario() {
  Scenario s;
  s.name = "ideal";
  s.camera.depth_sigma_per_m = 0.0;
  s.camera.disparity_quantum_px = 0.0;
  s.camera.edge_raggedness_px = 0.0;
  s.camera.color_noise_levels = 0.0;
  s.camera.exposure_s = 0.0;
  s.camera.auto_exposure = false;
  s.imu.gyro_sigma_rad_s = s.imu.gyro_bias_max_rad_s = s.imu.gyro_walk_rad_s_per_sqrt_s = 0.0;
  s.imu.accelerometer_sigma_m_s2 = s.imu.accelerometer_bias_max_m_s2 = 0.0;
  s.wheels.scale_error_max = s.wheels.track_error_max = s.wheels.slip_events_per_minute = 0.0;
  s.pose.sigma_position_m = s.pose.sigma_heading_rad = s.pose.latency_s = s.pose.jitter_s = 0.0;
  return s;
}

}  // namespace rovigo::sim
