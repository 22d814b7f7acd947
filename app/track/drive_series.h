#pragma once
// What a report draws of a run: a few samples a second, small enough to be kept for all runs.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/track/track_run.h"

namespace rovigo::app {

/// All vectors but the plan's are as long as `time_s`.
struct DriveSeries {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<double> time_s, x_m, y_m, cross_track_m, speed_m_s, turn_rate_rad_s;
  std::vector<double> planned_x_m, planned_y_m;
};

/// Ten samples a second, rounded to a tenth of a millimetre; speed and turn rate as commanded.
DriveSeries series_of(const TrackRun& run);

nlohmann::ordered_json series_json(const std::vector<DriveSeries>& series);
/// The series of a report's drives.json. Throws InputError saying what is wrong with it.
std::vector<DriveSeries> read_series(const std::filesystem::path& file);

}  // namespace rovigo::app
