// rovigo evaluate: an estimate against the truth.

#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/console.h"
#include "maps/map_evaluation.h"
#include "maps/map_file.h"
#include "maps/ros_map.h"
#include "slam/trajectory_evaluation.h"

namespace rovigo::app {

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
  rows.push_back({"free space", "IoU " + with_unit(object["free_iou"].get<double>(), 3, "")});
  console.result(object, "Occupied cells against the true grid:", rows);
  return kDone;
}

}  // namespace rovigo::app
