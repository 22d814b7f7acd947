// rovigo info: what a recording or a map holds; rescues what is whole in a damaged map.

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/console.h"
#include "maps/map_file.h"
#include "slam/recording/recording.h"

namespace rovigo::app {

namespace {

bool is_recording(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto extension = file.extension();
  return extension == ".rawlog" || extension == ".bag" ||
         std::filesystem::is_directory(file, ignored);
}

int describe_recording(const InfoOptions& options, const Console& console) {
  const auto reader = slam::open_recording(options.file);
  int frames = 0, imu = 0, wheels = 0;
  double first_s = 0.0, last_s = 0.0;
  {
    Progress progress("reading");
    while (const auto observation = reader->next()) {
      const double t = mrpt::Clock::toDouble(observation->timestamp);
      if (frames + imu + wheels == 0) first_s = t;
      last_s = std::max(last_s, t);
      frames += IS_CLASS(*observation, mrpt::obs::CObservation3DRangeScan);
      imu += IS_CLASS(*observation, mrpt::obs::CObservationIMU);
      wheels += IS_CLASS(*observation, mrpt::obs::CObservationOdometry);
      progress.update(reader->progress());
    }
  }
  const std::vector<std::string> warnings = reader->warnings();
  for (const auto& warning : warnings) console.warn(warning);
  const auto& info = reader->info();
  const auto& camera = info.rig.camera;
  const double duration = last_s - first_s;
  const auto rate = [&](int n) {
    return duration > 0.0 ? " at " + with_unit(n / duration, 0, "Hz") : std::string();
  };
  nlohmann::ordered_json object{{"status", "ok"},
                                {"code", 0},
                                {"message", "a recording"},
                                {"kind", "recording"},
                                {"format", info.format},
                                {"frames", frames},
                                {"imu_samples", imu},
                                {"wheel_samples", wheels},
                                {"skipped_frames", reader->skipped()},
                                {"duration_s", duration},
                                {"camera",
                                 {{"width", camera.ncols},
                                  {"height", camera.nrows},
                                  {"fx", camera.fx()},
                                  {"fy", camera.fy()},
                                  {"cx", camera.cx()},
                                  {"cy", camera.cy()}}},
                                {"has_extrinsics", info.rig.has_extrinsics}};
  if (info.simulation) object["world"] = info.simulation->world;
  for (const auto& [sensor, topic] : info.sources) object["sources"][sensor] = topic;
  object["warnings"] = warnings;
  std::vector<Row> rows = {
      {"duration", with_unit(duration, 2, "s")},
      {"RGB-D frames", std::to_string(frames) + rate(frames) + ", " + std::to_string(camera.ncols) +
                           " x " + std::to_string(camera.nrows)},
      {"IMU", imu ? std::to_string(imu) + " samples" + rate(imu) : "none"},
      {"wheels", wheels ? std::to_string(wheels) + " samples" + rate(wheels) : "none"},
      {"camera on the rover",
       info.rig.has_extrinsics ? "known" : "unknown: the camera is taken as the body"},
      {"simulated world", info.simulation ? info.simulation->world : "no"}};
  for (const auto& [sensor, topic] : info.sources) rows.emplace_back(sensor + " from", topic);
  console.result(object, options.file.string() + ": a recording (" + info.format + ")", rows);
  return kDone;
}

int describe_map(const InfoOptions& options, const Console& console) {
  std::vector<std::string> warnings;
  const maps::SavedMap map = maps::load_any_map(options.file, warnings);
  for (const auto& warning : warnings) console.warn(warning);
  const auto& g = map.grid.geometry;
  const auto occupied =
      std::count_if(map.grid.cells.begin(), map.grid.cells.end(), maps::OccupancyGrid::is_occupied);
  const auto free =
      std::count_if(map.grid.cells.begin(), map.grid.cells.end(), maps::OccupancyGrid::is_free);
  const double cell_m2 = g.resolution_m * g.resolution_m;
  const auto loops = std::count_if(map.edges.begin(), map.edges.end(), [](const auto& e) {
    return e.kind == maps::StoredEdge::Kind::kLoop;
  });
  nlohmann::ordered_json object{{"status", "ok"},
                                {"code", 0},
                                {"message", "a map"},
                                {"kind", "map"},
                                {"width", g.width},
                                {"height", g.height},
                                {"resolution_m", g.resolution_m},
                                {"origin", {g.origin.x, g.origin.y}},
                                {"occupied_cells", occupied},
                                {"free_cells", free},
                                {"keyframes", map.keyframes.size()},
                                {"edges", map.edges.size()},
                                {"loop_edges", loops},
                                {"poses", map.trajectory.size()},
                                {"places", map.places.size()},
                                {"zones", map.zones.size()},
                                {"recording", map.metadata.recording},
                                {"software_version", map.metadata.software_version}};
  if (map.metadata.simulation) object["world"] = map.metadata.simulation->world;
  console.result(
      object,
      options.file.string() + ": a map" +
          (map.metadata.recording.empty() ? "" : " of \"" + map.metadata.recording + "\""),
      {{"grid", std::to_string(g.width) + " x " + std::to_string(g.height) + " cells of " +
                    with_unit(g.resolution_m, 3, "m") + ", lower-left corner " +
                    with_unit(g.origin.x, 2, "") + "," + with_unit(g.origin.y, 2, "m")},
       {"free / occupied", with_unit(static_cast<double>(free) * cell_m2, 1, "m2") + " / " +
                               with_unit(static_cast<double>(occupied) * cell_m2, 1, "m2")},
       {"keyframes", std::to_string(map.keyframes.size())},
       {"graph",
        std::to_string(map.edges.size()) + " edges, " + std::to_string(loops) + " of them loops"},
       {"trajectory", std::to_string(map.trajectory.size()) + " poses"},
       {"places, zones",
        std::to_string(map.places.size()) + ", " + std::to_string(map.zones.size())}});
  return kDone;
}

int rescue(const InfoOptions& options, const Console& console) {
  const maps::RecoveredMap recovered = maps::recover_map(options.file);
  maps::save_map(recovered.map, *options.recover);
  for (const auto& lost : recovered.lost) console.warn(lost);
  const std::string message = "wrote what is whole to " + options.recover->string() + ", " +
                              std::to_string(recovered.lost.size()) + " things were lost";
  console.result({{"status", "ok"},
                  {"code", 0},
                  {"message", message},
                  {"lost", recovered.lost},
                  {"keyframes", recovered.map.keyframes.size()}},
                 message, {});
  return kDone;
}

}  // namespace

int run_info(const InfoOptions& options) {
  const Console console(options.json);
  if (options.recover) return rescue(options, console);
  return is_recording(options.file) ? describe_recording(options, console)
                                    : describe_map(options, console);
}

}  // namespace rovigo::app
