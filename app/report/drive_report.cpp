#include "app/report/drive_report.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "app/report/drive_page.h"
#include "app/report/drive_plots.h"
#include "app/report/drive_tables.h"
#include "maps/atomic_file.h"
#include "maps/error.h"

namespace rovigo::app {
namespace {

void make_folder(const std::filesystem::path& dir) {
  std::error_code problem;
  std::filesystem::create_directories(dir, problem);
  if (problem || !std::filesystem::is_directory(dir)) {
    throw maps::InputError("The report folder " + dir.string() + " cannot be made: " +
                           (problem ? problem.message() : "a file of that name is in the way") +
                           ".");
  }
}

bool same_as_truth(const control::DriveLog& log) {
  return std::all_of(log.steps.begin(), log.steps.end(), [](const control::DriveStep& s) {
    return s.quality == control::PoseQuality::kLost ||
           maps::distance(maps::position_of(s.true_pose), maps::position_of(s.estimated_pose)) <
               1e-9;
  });
}

/// The caller's layers, with the paths of the log where it gave none.
MapPictureLayers completed_layers(const DriveReportInput& in) {
  MapPictureLayers layers = in.layers;
  if (layers.planned_path.empty()) layers.planned_path = positions_of(in.planned.points);
  if (layers.driven_path.empty()) {
    for (const auto& s : in.log.steps) layers.driven_path.push_back(maps::position_of(s.true_pose));
  }
  if (layers.estimated_path.empty() && !same_as_truth(in.log)) {
    for (const auto& s : in.log.steps) {
      if (s.quality == control::PoseQuality::kLost) continue;
      layers.estimated_path.push_back(maps::position_of(s.estimated_pose));
    }
  }
  return layers;
}

}  // namespace

void write_drive_report(const std::filesystem::path& dir, const DriveReportInput& input) {
  make_folder(dir);
  const std::string map_png = map_picture_png(input.grid, completed_layers(input));
  const auto plots = drive_plots(input.log, input.planned);
  const auto write = [&dir](const std::string& name, const std::string& bytes) {
    maps::write_file_atomically(dir / name, std::string_view(bytes));
  };
  write("map.png", map_png);
  for (const NamedPlot& p : plots) write(p.file, plot_file(p.plot));
  write("trajectory.csv", path_csv(input.planned));
  write("drive.csv", drive_csv(input.log));
  write("trajectory_true.txt", trajectory_tum(input.log, WhichPose::kTrue));
  write("trajectory_estimated.txt", trajectory_tum(input.log, WhichPose::kEstimated));
  const bool ends_line = !input.drive_json.empty() && input.drive_json.back() == '\n';
  write("drive.json", input.drive_json + (ends_line ? "" : "\n"));
  write("index.html", drive_page(input, plots, map_png));  // last: it names all the others
}

}  // namespace rovigo::app
