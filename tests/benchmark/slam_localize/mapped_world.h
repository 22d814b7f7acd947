#pragma once
// A simulated world with a map of it, made by driving a tour; kept in a folder, made once.

#include <filesystem>
#include <string>
#include <vector>

#include "app/config.h"
#include "maps/map_file.h"
#include "sim/route.h"
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

/// The tour: `lab_tour` in the lab; elsewhere 40 m through random places, turning at each.
sim::Route mapping_route(const std::string& name, const sim::World& world,
                         const app::RovigoConfig& config);

/// Reads `folder/map.rovigo`; where it is missing, or with `remap`, drives the tour and maps it.
MappedWorld open_mapped_world(const std::string& name, const std::filesystem::path& folder,
                              const app::RovigoConfig& config, bool remap);

}  // namespace rovigo::slam_localize
