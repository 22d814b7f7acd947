// rovigo export and rovigo import: maps for other tools, and from them.

#include <nlohmann/json.hpp>

#include "app/commands/options.h"
#include "app/console.h"
#include "maps/error.h"
#include "maps/export.h"
#include "maps/map_file.h"

namespace rovigo::app {

int run_export(const ExportOptions& options) {
  const Console console(options.json);
  std::vector<std::string> warnings;
  const maps::SavedMap map = maps::load_any_map(options.map, warnings);
  for (const auto& warning : warnings) console.warn(warning);
  const auto format = maps::parse_export_format(options.format);
  if (!format) {
    throw maps::InputError("--format " + options.format +
                           ": must be ros, png, ply, pcd, octomap, gridmap, simplemap, trajectory, "
                           "geojson or keepout");
  }
  maps::export_map(map, *format, options.output);
  const std::string message = "wrote " + options.output.string();
  console.result(
      {{"status", "ok"}, {"code", 0}, {"message", message}, {"file", options.output.string()}},
      message, {});
  return kDone;
}

int run_import(const ImportOptions& options) {
  const Console console(options.json);
  std::vector<std::string> warnings;
  maps::SavedMap map = maps::load_any_map(options.source, warnings);
  for (const auto& warning : warnings) console.warn(warning);
  map.metadata.software_version = ROVIGO_VERSION;
  if (map.metadata.recording.empty()) map.metadata.recording = options.source.stem().string();
  maps::save_map(map, options.output);
  const std::string message =
      "imported " + options.source.string() + " to " + options.output.string();
  console.result({{"status", "ok"}, {"code", 0}, {"message", message}}, message,
                 {{"grid", std::to_string(map.grid.geometry.width) + " x " +
                               std::to_string(map.grid.geometry.height) + " cells"}});
  return kDone;
}

}  // namespace rovigo::app
