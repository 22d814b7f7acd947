#pragma once
// The one YAML configuration: a section for each module, every key declared in its config struct.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "control/control_config.h"
#include "control/docking_config.h"
#include "maps/inflation.h"
#include "maps/robot_model.h"
#include "planning/planner.h"
#include "slam/slam_config.h"

namespace rovigo::app {

struct RovigoConfig {
  maps::RobotModel robot;
  maps::InflationConfig inflation;
  slam::SlamConfig slam;
  planning::PlannerConfig planning;
  control::ControlConfig control;
  control::DockingConfig docking;
};

/// One setting as `rovigo config` shows it.
struct SettingRow {
  std::string key;  ///< "section.name"
  std::string type;
  std::string value;
  std::string range;  ///< "[min, max]", choices, or empty
  std::string help;
  bool advanced = true;
};

/// Defaults, then the file (if any), then `--set section.key=value` in order. Throws InputError
/// that lists every unknown, malformed or out-of-range setting at once, each with file and line
/// and, for an unknown key, the nearest valid one.
RovigoConfig load_config(const std::optional<std::filesystem::path>& file,
                         const std::vector<std::string>& assignments);

std::vector<SettingRow> list_settings(const RovigoConfig& config);

/// The settings as a Markdown table; `app/SETTINGS.md` is this, kept fresh by a test.
std::string settings_markdown();

}  // namespace rovigo::app
