#pragma once
// A simulated world with a map of it, made by driving a tour; kept in a folder, made once.

#include <filesystem>
#include <string>
#include <vector>

#include "app/config.h"
#include "maps/map_file.h"
#include "planning/trajectory.h"
#include "sim/world.h"

namespace rovigo::slam_localize {

struct MappedWorld {
  std::string name;
  std::filesystem::path folder;
  sim::World world;
  maps::OccupancyGrid true_grid;  ///< for putting rovers down, never shown to the localizer
  maps::SavedMap map;
  std::vector<TPose2D> driven;  ///< world_from_base along the mapping tour
  TPose2D world_from_map() const { return map.metadata.simulation->world_from_map; }
};

/// The tour: `lab_tour` in the lab; in a random office the shortest way through places that
/// between them see all reachable ground from at most 1.5 m. No turns in place are added.
planning::Trajectory plan_tour(const std::string& name, const sim::World& world,
                               const maps::OccupancyGrid& grid, const app::RovigoConfig& config);

/// Reads `folder/tour.rawlog` and `folder/map.rovigo`, making what is missing; `remap` makes the
/// map again from the recording.
MappedWorld open_mapped_world(const std::string& name, const std::filesystem::path& folder,
                              const app::RovigoConfig& config, bool remap);

}  // namespace rovigo::slam_localize
