#pragma once
// Where a simulated drive happens, and by which poses: what `drive` and `track` share.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/config.h"
#include "app/pose_source.h"
#include "maps/map_file.h"
#include "sim/simulator.h"
#include "sim/world.h"

namespace rovigo::app {

struct Ground {
  sim::World world;
  std::string name;  ///< for people
  TPose2D world_from_map;
};

/// The world asked for, the one the map was recorded in, or walls raised from its cells. Throws
/// InputError when a world does not exist.
Ground ground_of(const maps::SavedMap& map, const std::optional<std::string>& world);

struct PoseSourceRequest {
  std::string kind;  ///< slam, odometry, perturbed or truth
  std::string map_name;
  TPose2D start;  ///< map_from_base
  std::uint64_t seed = 1;
};

/// Poses in the map's frame; simulator, map and config must outlive them. Throws InputError for a
/// map without what the kind needs.
std::unique_ptr<PoseSource> open_poses(const PoseSourceRequest& request, const RovigoConfig& config,
                                       const maps::SavedMap& map, const TPose2D& world_from_map,
                                       const sim::Simulator& simulator,
                                       const sim::Scenario& scenario);

/// Do poses of this kind need the camera?
bool needs_camera(const std::string& pose_kind);

/// Can poses of this kind be found again by looking around?
bool finds_itself(const std::string& pose_kind);

}  // namespace rovigo::app
