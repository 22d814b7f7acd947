// rovigo localize: a recording and a map in, poses in that map out.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/recording_run.h"
#include "app/resources.h"
#include "maps/atomic_file.h"
#include "maps/error.h"
#include "slam/localizer.h"
#include "slam/pose_outlier_filter.h"

namespace rovigo::app {

namespace {

/// One line a camera frame, the LOST ones too: how far each pose could be trusted. The pose is also
/// given as the outlier filter of mission F3 shows it, for those who draw it.
void write_health(const std::filesystem::path& file,
                  const std::vector<slam::PoseEstimate>& frames) {
  std::ostringstream out;
  out << "time_s,health,confidence,sigma_position_m,sigma_heading_rad,x_m,y_m,heading_rad,"
         "shown_x_m,shown_y_m,shown_heading_rad\n";
  out.precision(17);
  slam::PoseOutlierFilter filter;
  for (const slam::PoseEstimate& e : frames) {
    const TPose2D pose(e.map_from_base.asTPose());
    out << e.time_s << ',' << to_string(e.health) << ',' << e.confidence << ','
        << e.sigma_position_m << ',' << e.sigma_heading_rad;
    if (e.health == slam::Health::kLost) {
      filter = slam::PoseOutlierFilter();
      out << ",,,,,,\n";
      continue;
    }
    const auto shown = filter.add({pose.x, pose.y, pose.phi});
    out << ',' << pose.x << ',' << pose.y << ',' << pose.phi << ',' << shown[0] << ',' << shown[1]
        << ',' << shown[2] << '\n';
  }
  maps::write_file_atomically(file, out.str());
}

}  // namespace

int run_localize(const LocalizeOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  if (options.trajectory) require_writable(*options.trajectory);
  if (options.health) require_writable(*options.health);
  const maps::SavedMap map = maps::load_map(options.map);
  const auto reader = slam::open_recording(options.recording, {.camera_info = options.camera_info});
  slam::Localizer localizer(config.slam, reader->info().rig, map, std::nullopt);

  slam::PoseEstimate last;
  std::vector<slam::PoseEstimate> frames;
  std::vector<maps::StoredPose> poses;
  std::optional<double> first_fix_s;
  int ok_frames = 0;
  const Reading reading = read_all(*reader, "localizing", console, [&](const auto& observation) {
    last = localizer.process(observation);
    const bool is_frame = IS_CLASS(observation, mrpt::obs::CObservation3DRangeScan);
    if (is_frame) frames.push_back(last);
    if (last.health == slam::Health::kLost) return;
    poses.push_back({last.time_s, last.map_from_base, is_frame});
    if (last.health != slam::Health::kOk) return;
    if (!first_fix_s) first_fix_s = last.time_s;
    if (is_frame) ++ok_frames;
  });
  if (reading.frame_times_s.empty()) {
    throw maps::InputError(options.recording.string() + ": holds no RGB-D frame to localise with");
  }
  if (options.health) write_health(*options.health, frames);
  if (options.trajectory) {
    write_trajectory(*options.trajectory, poses, options.frame,
                     reader->info().rig.base_from_camera);
  }

  const bool ok = first_fix_s.has_value();
  const double tracked =
      static_cast<double>(ok_frames) / static_cast<double>(reading.frame_times_s.size());
  const double covered =
      coverage(poses, reading.frame_times_s.front(), reading.frame_times_s.back());
  const std::string message =
      ok ? "localised" : "never recognised the place: is it in this map, and lit and seen as then?";
  nlohmann::ordered_json object{
      {"status", ok ? "ok" : "not_localized"},
      {"code", ok ? 0 : 104},
      {"message", message},
      {"localized", ok},
      {"first_fix_s", nullptr},
      {"coverage", covered},
      {"tracked_fraction", tracked},
      {"health", {{"state", to_string(last.health)}, {"confidence", last.confidence}}},
      {"warnings", reading.warnings},
      {"cpu_ms_per_frame", reading.cpu_ms_per_frame()},
      {"peak_rss_mb", peak_rss_mb()}};
  if (first_fix_s) object["first_fix_s"] = *first_fix_s;
  console.result(object, message,
                 {{"first fix", ok ? with_unit(*first_fix_s - reading.frame_times_s.front(), 1,
                                               "s after the first frame")
                                   : "never"},
                  {"tracked", percent(tracked) + " of the frames"},
                  {"health at the end", std::string(to_string(last.health)) + ", confidence " +
                                            with_unit(last.confidence, 2, "")}});
  return ok ? kDone : kDidNotSucceed;
}

}  // namespace rovigo::app
