#pragma once
// The folder a person opens after a drive: one page, pictures, and the numbers behind them.

#include <filesystem>
#include <string>
#include <vector>

#include "app/report/map_picture.h"
#include "control/drive_log.h"
#include "control/tracking_metrics.h"
#include "maps/occupancy_grid.h"
#include "planning/trajectory.h"

namespace rovigo::app {

/// One row of the page's "passed or not" table: a figure against its limit.
struct ReportCheck {
  std::string name;  ///< for example "Cross-track error, RMS"
  double value = 0.0;
  double limit = 0.0;  ///< passes when value <= limit
  std::string unit;    ///< "m", "rad", ""
};

struct DriveReportInput {
  std::string title;    ///< "Drive to (4.00, 2.50)"
  std::string summary;  ///< one sentence on how it ended, for people
  std::string command;  ///< the command line that repeats it; may be empty
  bool succeeded = false;
  maps::OccupancyGrid grid;  ///< in the map frame
  MapPictureLayers layers;  ///< filled in by the caller as far as known; paths default to the log's
  planning::Trajectory planned;
  control::DriveLog log;
  control::DriveMetrics metrics;
  control::CommandLimits limits;
  std::vector<ReportCheck> checks;
  /// Further facts for the page, in order: {"World", "lab"}, {"Seed", "1"} ...
  std::vector<std::pair<std::string, std::string>> facts;
  std::string drive_json;  ///< the JSON object of `rovigo drive --json`, written as drive.json
};

/// Writes index.html, map.png, plots as .svg, drive.json, trajectory.csv, drive.csv,
/// trajectory_true.txt, trajectory_estimated.txt (TUM) into `dir`, which is created when missing.
/// Same input, same bytes. Throws InputError when a file cannot be written.
void write_drive_report(const std::filesystem::path& dir, const DriveReportInput& input);

/// The plan as CSV: t_s,x_m,y_m,yaw_rad,v_m_s,w_rad_s,curvature_1_m.
std::string path_csv(const planning::Trajectory& trajectory);
/// path_csv() written atomically. Throws InputError when it cannot be written.
void write_path_csv(const std::filesystem::path& csv, const planning::Trajectory& trajectory);

}  // namespace rovigo::app
