// rovigo evaluate: an estimate against the truth.

#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/config.h"
#include "app/console.h"
#include "maps/free_space_evaluation.h"
#include "maps/map_evaluation.h"
#include "maps/map_file.h"
#include "maps/ros_map.h"
#include "slam/trajectory_evaluation.h"
#include "slam/trajectory_file.h"

namespace rovigo::app {

namespace {

// Floor seen under more than this returns no depth.
constexpr double kSteepestIncidenceRad = 80.0 * maps::kPi / 180.0;

/// Where the camera was: by the true poses where they lie beside the true grid (as `record --truth`
/// writes them), else by the map's own.
std::vector<maps::View> views(const maps::SavedMap& map, const std::filesystem::path& true_poses,
                              const TPose2D& truth_from_map) {
  constexpr std::size_t kEvery = 5;  // neighbouring frames see the same ground
  std::vector<mrpt::poses::CPose3D> poses;
  if (std::filesystem::exists(true_poses)) {
    for (const auto& p : slam::read_tum_trajectory(true_poses)) poses.push_back(p.pose);
  } else {
    for (const auto& p : map.trajectory) {
      if (p.is_camera_frame) poses.push_back(p.map_from_base);
    }
  }
  std::vector<maps::View> out;
  for (std::size_t i = 0; i < poses.size(); i += kEvery) {
    const auto at = mrpt::poses::CPose3D(mrpt::poses::CPose2D(truth_from_map)) + poses[i] +
                    map.metadata.base_from_camera;
    const auto ahead = at.composePoint({0.0, 0.0, 1.0});  // along the optical axis
    out.push_back({TPose2D(at.x(), at.y(), std::atan2(ahead.y - at.y(), ahead.x - at.x()))});
  }
  return out;
}

maps::FieldOfView field_of(const maps::MapMetadata& map, double range_m) {
  const mrpt::img::TCamera& camera = map.camera;
  return {std::atan2(camera.cx(), camera.fx()),
          std::atan2(static_cast<double>(camera.ncols) - camera.cx(), camera.fx()), range_m,
          std::max(0.0, map.base_from_camera.z()) * std::tan(kSteepestIncidenceRad)};
}

std::optional<double> seen_free_iou(const EvaluateMapOptions& options, const maps::SavedMap& map,
                                    const maps::OccupancyGrid& truth,
                                    const TPose2D& truth_from_map) {
  const RovigoConfig config = load_config(options.config, options.set);
  const auto from =
      views(map, options.truth.parent_path() / "base_groundtruth.txt", truth_from_map);
  if (from.empty() || !(map.metadata.camera.fx() > 0.0)) return std::nullopt;  // not a camera's map
  const auto in_view =
      maps::cells_in_view(truth, from, field_of(map.metadata, config.slam.depth.max_depth_m));
  return maps::free_iou_in_view(map.grid, truth, truth_from_map, in_view);
}

}  // namespace

int run_evaluate_trajectory(const EvaluateTrajectoryOptions& options) {
  const Console console(options.json);
  const auto estimate = slam::read_tum_trajectory(options.estimate);
  const auto truth = slam::read_tum_trajectory(options.truth);
  const slam::TrajectoryErrors e = slam::evaluate_trajectory(estimate, truth);
  console.result({{"status", "ok"},
                  {"code", 0},
                  {"message", "compared " + std::to_string(e.associated) + " poses"},
                  {"associated", e.associated},
                  {"ate_rmse_m", e.ate_rmse_m},
                  {"ate_max_m", e.ate_max_m},
                  {"rpe_translation_m", e.rpe_translation_m},
                  {"rpe_rotation_rad", e.rpe_rotation_rad},
                  {"coverage", e.coverage},
                  {"similarity_scale", e.similarity_scale}},
                 "Trajectory against truth, " + std::to_string(e.associated) + " poses:",
                 {{"ATE, RMSE", with_unit(e.ate_rmse_m, 4, "m")},
                  {"ATE, worst", with_unit(e.ate_max_m, 4, "m")},
                  {"RPE over 1 s", with_unit(e.rpe_translation_m, 4, "m") + ", " +
                                       with_unit(e.rpe_rotation_rad, 4, "rad")},
                  {"coverage", with_unit(100 * e.coverage, 1, "%")},
                  {"similarity scale", with_unit(e.similarity_scale, 4, "")}});
  return kDone;
}

int run_evaluate_map(const EvaluateMapOptions& options) {
  const Console console(options.json);
  std::vector<std::string> warnings;
  const maps::SavedMap map = maps::load_any_map(options.map, warnings);
  const maps::SavedMap truth = maps::load_any_map(options.truth, warnings);
  for (const auto& w : warnings) console.warn(w);
  // The true grid lies in the world's frame; a map of a simulated recording knows where it began.
  const TPose2D truth_from_map =
      map.metadata.simulation ? map.metadata.simulation->world_from_map : TPose2D();

  nlohmann::ordered_json object{{"status", "ok"}, {"code", 0}, {"message", "compared the grids"}};
  std::vector<Row> rows;
  for (const int cells : {1, 2}) {
    const maps::MapScores s = maps::evaluate_map(map.grid, truth.grid, truth_from_map, cells);
    const std::string within = "within_" + std::to_string(cells) + "_cells";
    object[within] = {{"precision", s.precision}, {"recall", s.recall}};
    object["free_iou"] = s.free_iou;
    rows.push_back(
        {"within " + std::to_string(cells) + (cells == 1 ? " cell" : " cells"),
         "precision " + with_unit(s.precision, 3, "") + ", recall " + with_unit(s.recall, 3, "")});
  }
  // The figures the demo is judged by, at the top level.
  object["precision"] = object["within_2_cells"]["precision"];
  object["recall"] = object["within_2_cells"]["recall"];
  rows.push_back({"free space, whole world",
                  "IoU " + with_unit(object["free_iou"].get<double>(), 3, "") +
                      " (of all cells known in the truth, rooms never visited too: free in both / "
                      "free in either)"});
  object["free_iou_in_view"] = nullptr;
  if (const auto iou = seen_free_iou(options, map, truth.grid, truth_from_map)) {
    object["free_iou_in_view"] = *iou;
    rows.push_back(
        {"free space in view",
         "IoU " + with_unit(*iou, 3, "") +
             " (truly free cells are asked for only where the camera had a line of sight "
             "within its range; whatever the map calls free is judged everywhere)"});
  }
  console.result(object, "Occupied cells against the true grid:", rows);
  return kDone;
}

}  // namespace rovigo::app
