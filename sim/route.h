#pragma once
// A route file: where the simulated rover drives while a recording is made.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "maps/geometry.h"

namespace rovigo::sim {

/// The rover stops at a waypoint and turns in place before it goes on.
struct RouteTurn {
  std::size_t waypoint = 0;
  double turn_rad = 0.0;  ///< to the left positive; may be more than one revolution
};

struct Route {
  std::string name;                 ///< the file's name without its extension
  std::vector<TPoint2D> waypoints;  ///< world frame; driven in order, the first is the start
  double speed_m_s = 0.4;
  std::optional<double> start_yaw_rad;  ///< none: as the way to the second waypoint begins
  std::vector<RouteTurn> turns;         ///< by waypoint, ascending
  double turn_rate_rad_s = 1.5;         ///< of those turns
  int laps = 1;                         ///< how often the whole route is driven
  std::string world;                    ///< the world it was made for; empty: any
};

/// YAML: `waypoints`, each `[x, y]` or `{at: [x, y], turn_deg: 360}`; optionally `speed_m_s`,
/// `turn_rate_rad_s`, `laps` and `world`. Without a heading of its own the rover starts facing its
/// second waypoint. Throws InputError naming file, line, value and limit.
Route load_route(const std::filesystem::path& file);

/// The same from text; `file` is used in messages and for the route's name.
Route parse_route(const std::string& yaml, const std::string& file);

}  // namespace rovigo::sim
