#pragma once
// The simulated rover drives a route for a recording, on true poses: from place to place, turning
// where the route says so, and going on from wherever somebody carried it to.

#include <string>
#include <vector>

#include "app/config.h"
#include "app/simulated_drive.h"
#include "planning/planner.h"
#include "sim/route.h"
#include "sim/world.h"

namespace rovigo::app {

/// The world's true grid as the rover meets it: everything between 0.02 m and a little above the
/// body is an obstacle.
maps::OccupancyGrid obstacle_grid(const sim::World& world, const RovigoConfig& config);

/// Plans on the world's true grid: everything between 0.02 m and a little above the body is an
/// obstacle (true poses and grids are allowed in `record`, and only there).
planning::Planner route_planner(const sim::World& world, const RovigoConfig& config,
                                double speed_m_s);

/// Where the rover is put down. Throws InputError naming the leg that cannot be driven, so that no
/// recording begins that cannot end.
TPose2D route_start(const sim::Route& route, const sim::World& world,
                    const planning::Planner& planner);

struct RouteDriveResult {
  control::DriveLog log;  ///< of all legs and turns
  bool completed = false;
  std::string message;            ///< why not
  double planned_length_m = 0.0;  ///< of what was planned and driven, kidnaps aside
  int kidnaps = 0;
};

/// The rover must stand at `start`, which is route_start()'s. Stands still for a second, drives
/// every lap, stands still for half a second.
RouteDriveResult drive_route(sim::Simulator& simulator, const sim::Route& route,
                             const TPose2D& start, const planning::Planner& planner,
                             const RovigoConfig& config, const DriveHooks& hooks);

}  // namespace rovigo::app
