#pragma once
// The exchange plug-in: formats that need heavy libraries, in a module of its own that is loaded
// only when one of them is asked for (PCL's file library alone brings 67 others and 0.2 s).

#include <functional>
#include <string>
#include <vector>

#include "maps/map_file.h"
#include "maps/occupancy_grid.h"
#include "maps/view_cloud.h"

namespace rovigo::maps {

/// The keyframe's pose, decoded depth and colour, as CSimpleMap wants them.
struct ExchangeView {
  mrpt::poses::CPose3D map_from_base;
  double time_s = 0.0;
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> depth_mm;  ///< row-major; empty: none
  Blob color_jpeg;                      ///< empty: none
};

/// Every function writes `file` and returns what went wrong, in a few words; empty: nothing.
/// Exceptions do not leave the module.
struct ExchangePlugin {
  std::string (*write_ply)(const std::vector<ColoredPoint>& points, const std::string& file);
  std::string (*write_pcd)(const std::vector<ColoredPoint>& points, const std::string& file);
  /// `next` fills in one view after another and returns false when there are no more.
  std::string (*write_octomap)(const std::function<bool(ViewPoints&)>& next, double resolution_m,
                               const std::string& file);
  std::string (*write_octomap_layer)(const OccupancyGrid& grid, const std::string& file);
  std::string (*write_gridmap)(const OccupancyGrid& grid, const std::string& file);
  std::string (*write_simplemap)(const MapMetadata& metadata,
                                 const std::function<bool(ExchangeView&)>& next,
                                 const std::string& file);
};

/// What the loader looks up in the module.
inline constexpr char kExchangePluginSymbol[] = "rovigo_exchange_plugin";
inline constexpr char kExchangePluginFile[] = "rovigo_exchange.so";

}  // namespace rovigo::maps
