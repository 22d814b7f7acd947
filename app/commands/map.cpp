// rovigo map: a recording in, a map file out.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/recording_run.h"
#include "app/resources.h"
#include "maps/error.h"
#include "maps/map_file.h"
#include "slam/recording/recording.h"
#include "slam/slam.h"

namespace rovigo::app {

int run_map(const MapOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  require_writable(options.output);
  if (options.trajectory) require_writable(*options.trajectory);
  const auto reader = slam::open_recording(options.recording, {.camera_info = options.camera_info});

  slam::Slam slam(config.slam, reader->info().rig);
  const Reading reading = read_all(*reader, "mapping", console,
                                   [&](const auto& observation) { slam.process(observation); });
  if (reading.frame_times_s.empty()) {
    throw maps::InputError(options.recording.string() +
                           ": holds no RGB-D frame; a map needs at least one (see `rovigo info`)");
  }
  const double cpu_before = cpu_seconds();
  maps::SavedMap map = slam.finish();
  const double cpu_ms_per_frame = reading.cpu_ms_per_frame(cpu_seconds() - cpu_before);
  map.metadata.software_version = ROVIGO_VERSION;
  map.metadata.recording = reader->info().name;
  map.metadata.simulation = reader->info().simulation;
  maps::save_map(map, options.output);
  if (options.trajectory) {
    write_trajectory(*options.trajectory, map.trajectory, options.frame,
                     map.metadata.base_from_camera);
  }

  const slam::SlamSummary summary = slam.summary();
  const double tracked = static_cast<double>(summary.tracked_frames) / summary.camera_frames;
  const double covered =
      coverage(map.trajectory, reading.frame_times_s.front(), reading.frame_times_s.back());
  const bool ok = summary.tracked_frames > 0;
  const std::string message =
      ok ? "mapped " + options.recording.string() + " to " + options.output.string()
         : "tracking was lost from the first frame on: too dark, too plain or out of depth range";
  console.result({{"status", ok ? "ok" : "tracking_lost"},
                  {"code", ok ? 0 : 104},
                  {"message", message},
                  {"frames", summary.camera_frames},
                  {"duration_s", reading.duration_s()},
                  {"coverage", covered},
                  {"tracked_fraction", tracked},
                  {"loop_closures", summary.loop_closures},
                  {"keyframes", summary.keyframes},
                  {"floor",
                   {{"height_m", summary.floor_height_m},
                    {"tilt_rad", summary.floor_tilt_rad},
                    {"looks", summary.floor_looks}}},
                  {"skipped_frames", reader->skipped()},
                  {"warnings", reading.warnings},
                  {"cpu_ms_per_frame", cpu_ms_per_frame},
                  {"peak_rss_mb", peak_rss_mb()}},
                 message,
                 {{"frames", std::to_string(summary.camera_frames) + " in " +
                                 with_unit(reading.duration_s(), 1, "s")},
                  {"tracked", percent(tracked) + " of the frames, poses for " + percent(covered) +
                                  " of the time"},
                  {"keyframes", std::to_string(summary.keyframes) + ", " +
                                    std::to_string(summary.loop_closures) + " loops closed"},
                  {"grid", std::to_string(map.grid.geometry.width) + " x " +
                               std::to_string(map.grid.geometry.height) + " cells of " +
                               with_unit(map.grid.geometry.resolution_m, 2, "m")},
                  {"effort", with_unit(cpu_ms_per_frame, 1, "ms CPU per frame") + ", " +
                                 with_unit(peak_rss_mb(), 0, "MB")}});
  return ok ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
