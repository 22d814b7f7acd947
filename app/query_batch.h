#pragma once
// Many planning queries in one file.

#include <filesystem>
#include <vector>

#include "maps/grid_geometry.h"

namespace rovigo::app {

struct PointPair {
  TPoint2D start;
  TPoint2D goal;
};

/// A CSV with the columns start_x,start_y,goal_x,goal_y (metres, header optional) or a MovingAI
/// `.scen`, whose column x, row y is the point (x + 0.5, height - y - 0.5) of a grid of 1 m cells.
/// Throws InputError naming file and line.
std::vector<PointPair> read_query_batch(const std::filesystem::path& file,
                                        const maps::GridGeometry& grid);

}  // namespace rovigo::app
