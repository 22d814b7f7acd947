#pragma once
// The folder a person opens after a suite: the page, the figures, and every run's trajectories.

#include <filesystem>
#include <vector>

#include "app/report/track_page.h"

namespace rovigo::app {

/// Makes the folder and its trajectories/. Throws InputError when it cannot.
void make_track_folder(const std::filesystem::path& dir);

/// Writes a run's true and estimated poses, TUM format. Runs may be written at the same time.
void write_trajectories(const std::filesystem::path& dir, const TrackRun& run);

/// Brings the drives of shards' reports, which lie beside `files`, into the order of `result`, and
/// copies their trajectories to `dir`. Throws InputError naming what is missing.
std::vector<DriveSeries> gather_drives(const std::vector<std::filesystem::path>& files,
                                       const TrackResult& result, const std::filesystem::path& dir);

/// index.html, track.json, runs.csv and drives.json. Same input, same bytes.
void write_track_report(const std::filesystem::path& dir, const TrackPageInput& input);

}  // namespace rovigo::app
