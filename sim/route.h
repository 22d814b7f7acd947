#pragma once
// A route file: where the simulated rover drives while a recording is made.

#include <filesystem>
#include <string>
#include <vector>

#include "maps/geometry.h"

namespace rovigo::sim {

struct Route {
  std::string name;                 ///< the file's name without its extension
  std::vector<TPoint2D> waypoints;  ///< world frame; driven in order, the first from the start
  double speed_m_s = 0.4;
  std::string world;  ///< the world it was made for; empty: any
};

/// YAML: `waypoints: [[x, y], ...]`, optionally `speed_m_s` and `world`. Throws InputError naming
/// file, line, value and limit.
Route load_route(const std::filesystem::path& file);

/// The same from text; `file` is used in messages and for the route's name.
Route parse_route(const std::string& yaml, const std::string& file);

}  // namespace rovigo::sim
