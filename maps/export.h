#pragma once
// Saved maps for other tools.

#include <filesystem>
#include <optional>
#include <string>

#include "maps/map_file.h"

namespace rovigo::maps {

enum class ExportFormat {
  kRos,        ///< map_server YAML and PGM
  kPng,        ///< a picture for people
  kPly,        ///< coloured point cloud of the kept views, map frame, metres
  kPcd,        ///< the same for PCL
  kOctomap,    ///< binary OctoMap (.bt) of the kept views, or of the grid as one layer without them
  kGridmap,    ///< serialised MRPT COccupancyGridMap2D
  kSimplemap,  ///< serialised MRPT CSimpleMap: poses and RGB-D observations of the kept views
  kTrajectory,  ///< TUM text: t tx ty tz qx qy qz qw of map_from_base_link
  kGeojson,     ///< places, zones, trajectory and outline, in metres of the map frame
  kKeepout,     ///< map_server YAML and PGM with the no-go zones occupied, all else free
};

/// `ros`, `png`, ... as on the command line.
std::optional<ExportFormat> parse_export_format(const std::string& text);

struct ExportConfig {
  double cloud_voxel_m = 0.02;  ///< points of the cloud are averaged in cubes of this size
  double octomap_resolution_m = 0.05;
  /// Where the exchange plug-in lies (PCL, OctoMap and MRPT's map classes are loaded only when one
  /// of their formats is asked for); empty: beside the running program.
  std::filesystem::path plugin_folder = {};
};

/// Writes `map` to `output`, atomically, companions beside it (`ros`, `keepout`: the image).
/// Throws InputError when the map lacks what the format needs or the file cannot be written.
void export_map(const SavedMap& map, ExportFormat format, const std::filesystem::path& output,
                const ExportConfig& config = {});

/// The text of the trajectory and geojson formats.
std::string trajectory_text(const SavedMap& map);
std::string geojson_text(const SavedMap& map);

/// A PNG of the grid's known part with trajectory, places, zones and a scale bar.
Blob draw_map_png(const SavedMap& map);

}  // namespace rovigo::maps
