#pragma once
// A picture of a map for people: what is known, what was planned, what was driven.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "maps/costmap.h"
#include "maps/geometry.h"
#include "maps/occupancy_grid.h"

namespace rovigo::app {

/// What lies over the grid; empty layers are not drawn and do not appear in the legend.
/// All in the grid's frame, metres.
struct MapPictureLayers {
  std::vector<TPoint2D> planned_path;
  std::vector<TPoint2D> driven_path;     ///< true poses
  std::vector<TPoint2D> estimated_path;  ///< poses the controller was given
  std::optional<TPose2D> start;
  std::optional<TPose2D> goal;
  bool goal_heading_given = false;  ///< draws the goal's arrow
  std::vector<TPoint2D> via_points;
  std::vector<std::vector<TPoint2D>> footprints;  ///< outlines of the rover along its path
  std::vector<TPose2D> keyframes;
  std::optional<maps::Costmap> costmap;  ///< same geometry as the grid; its lethal band is tinted
  std::string title = {};                ///< one short line above the picture; may be empty
};

/// The picture as PNG bytes: cropped to the known area and the layers with a margin, the map's
/// longer side 800..1600 px, with legend and scale bar. Same input, same bytes.
/// Throws InputError when the grid is empty or absurdly large.
std::string map_picture_png(const maps::OccupancyGrid& grid, const MapPictureLayers& layers);

/// map_picture_png() written atomically to `png`. Throws InputError when it cannot be written.
void write_map_picture(const std::filesystem::path& png, const maps::OccupancyGrid& grid,
                       const MapPictureLayers& layers);

/// The trajectory as positions, for MapPictureLayers.
template <class Points>
std::vector<TPoint2D> positions_of(const Points& points) {
  std::vector<TPoint2D> out;
  out.reserve(points.size());
  for (const auto& p : points) out.push_back(maps::position_of(p.pose));
  return out;
}

}  // namespace rovigo::app
