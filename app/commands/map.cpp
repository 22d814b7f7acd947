// rovigo map and rovigo localize: a recording in; a map file, or poses in one, out.

#include <malloc.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "app/resources.h"
#include "maps/error.h"
#include "maps/map_file.h"
#include "slam/localizer.h"
#include "slam/recording/recording.h"
#include "slam/slam.h"
#include "slam/trajectory_file.h"

namespace rovigo::app {

namespace {

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Images come and go between what is kept: glibc's heap would grow to more than twice of what is in
// use. Every so many observations what lies free goes back to the system.
constexpr int kTrimEvery = 500;

/// What reading a whole recording showed, whatever it was read for.
struct Reading {
  std::vector<double> frame_times_s;
  std::vector<std::string> warnings;  ///< of the reader, already shown
  double cpu_s = 0.0;                 ///< reading and decoding included
  double cpu_ms_per_frame(double more_s = 0.0) const {
    return 1e3 * (cpu_s + more_s) /
           static_cast<double>(std::max<std::size_t>(1, frame_times_s.size()));
  }
  double duration_s() const {
    return frame_times_s.empty() ? 0.0 : frame_times_s.back() - frame_times_s.front();
  }
};

Reading read_all(slam::RecordingReader& reader, const std::string& label, const Console& console,
                 const std::function<void(const mrpt::obs::CObservation&)>& take) {
  Reading reading;
  Progress progress(label);
  const double cpu_before = cpu_seconds();
  int taken = 0;
  while (const auto observation = reader.next()) {
    if (IS_CLASS(*observation, mrpt::obs::CObservation3DRangeScan)) {
      reading.frame_times_s.push_back(mrpt::Clock::toDouble(observation->timestamp));
    }
    take(*observation);
    if (++taken % kTrimEvery == 0) malloc_trim(0);
    progress.update(reader.progress());
  }
  reading.cpu_s = cpu_seconds() - cpu_before;
  reading.warnings = reader.warnings();
  for (const std::string& warning : reading.warnings) console.warn(warning);
  return reading;
}

std::vector<slam::StampedPose> in_frame(const std::vector<maps::StoredPose>& trajectory,
                                        const std::string& frame,
                                        const mrpt::poses::CPose3D& base_from_camera) {
  std::vector<slam::StampedPose> out;
  out.reserve(trajectory.size());
  for (const auto& p : trajectory) {
    out.push_back(
        {p.time_s, frame == "camera" ? p.map_from_base + base_from_camera : p.map_from_base});
  }
  return out;
}

void write_trajectory(const std::filesystem::path& file,
                      const std::vector<maps::StoredPose>& trajectory, const std::string& frame,
                      const mrpt::poses::CPose3D& base_from_camera) {
  slam::write_tum_trajectory(file, "map_from_" + frame,
                             in_frame(trajectory, frame, base_from_camera));
}

/// Share of the time between first and last camera frame with a pose within 0.02 s.
double coverage(const std::vector<maps::StoredPose>& poses, double begin_s, double end_s) {
  constexpr double kReachS = 0.02;
  if (end_s <= begin_s) return poses.empty() ? 0.0 : 1.0;
  double covered = 0.0;
  double reached = begin_s;  // everything before is counted
  for (const auto& pose : poses) {
    const double from = std::max(reached, pose.time_s - kReachS);
    const double to = std::min(end_s, pose.time_s + kReachS);
    if (to > from) {
      covered += to - from;
      reached = to;
    }
  }
  return covered / (end_s - begin_s);
}

std::string percent(double share) { return with_unit(100.0 * share, 1, "%"); }

}  // namespace

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
  malloc_trim(0);
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

int run_localize(const LocalizeOptions& options) {
  const Console console(options.json);
  const RovigoConfig config = load_config(options.config, options.set);
  if (options.trajectory) require_writable(*options.trajectory);
  const maps::SavedMap map = maps::load_map(options.map);
  const auto reader = slam::open_recording(options.recording, {.camera_info = options.camera_info});
  slam::Localizer localizer(config.slam, reader->info().rig, map, std::nullopt);

  slam::PoseEstimate last;
  std::vector<maps::StoredPose> poses;
  std::optional<double> first_fix_s;
  int ok_frames = 0;
  const Reading reading = read_all(*reader, "localizing", console, [&](const auto& observation) {
    last = localizer.process(observation);
    if (last.health == slam::Health::kLost) return;
    const bool is_frame = IS_CLASS(observation, mrpt::obs::CObservation3DRangeScan);
    poses.push_back({last.time_s, last.map_from_base, is_frame});
    if (last.health != slam::Health::kOk) return;
    if (!first_fix_s) first_fix_s = last.time_s;
    if (is_frame) ++ok_frames;
  });
  if (reading.frame_times_s.empty()) {
    throw maps::InputError(options.recording.string() + ": holds no RGB-D frame to localise with");
  }
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
