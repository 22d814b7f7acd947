#pragma once
// Grid maps and scenario files of the MovingAI pathfinding benchmarks.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// Reads a `.map`: cells of 1 m, the lower-left corner at the origin, row 0 of the file on top;
/// `.` and `G` are free, everything else is occupied. `name` is used in messages.
/// Throws InputError naming line and value for anything malformed or cut off.
OccupancyGrid parse_movingai_map(std::string_view text, const std::string& name);
OccupancyGrid load_movingai_map(const std::filesystem::path& path);

/// One line of a scenario file. Cells are counted as in the file: x from the left, y from the top.
struct MovingAiProblem {
  int bucket = 0;
  std::string map;
  int map_width = 0;
  int map_height = 0;
  Cell start_in_file;
  Cell goal_in_file;
  double optimal_length = 0.0;  ///< in cells: octile, no corner cutting

  /// The same places as points of the grid parse_movingai_map() gives, metres.
  TPoint2D start() const { return point(start_in_file); }
  TPoint2D goal() const { return point(goal_in_file); }

 private:
  TPoint2D point(Cell c) const { return {c.x + 0.5, map_height - c.y - 0.5}; }
};

/// Reads a `.scen`. Throws InputError naming line and value.
std::vector<MovingAiProblem> parse_movingai_scenario(std::string_view text,
                                                     const std::string& name);
std::vector<MovingAiProblem> load_movingai_scenario(const std::filesystem::path& path);

}  // namespace rovigo::maps
