#include "app/ground.h"

#include "app/resources.h"
#include "maps/error.h"

namespace rovigo::app {

namespace {

constexpr double kRaisedWallHeightM = 1.0;

}  // namespace

Ground ground_of(const maps::SavedMap& map, const std::optional<std::string>& world) {
  const auto& origin = map.metadata.simulation;
  const TPose2D world_from_map = origin ? origin->world_from_map : TPose2D();
  if (world) return {open_world(*world), *world, world_from_map};
  if (origin) return {open_world(origin->world), origin->world, world_from_map};
  return {sim::World::from_grid(map.grid, kRaisedWallHeightM), "walls raised from the map",
          TPose2D()};
}

std::unique_ptr<PoseSource> open_poses(const PoseSourceRequest& request, const RovigoConfig& config,
                                       const maps::SavedMap& map, const TPose2D& world_from_map,
                                       const sim::Simulator& simulator,
                                       const sim::Scenario& scenario) {
  slam::Rig rig;
  rig.camera = simulator.rig().camera;
  rig.base_from_camera = simulator.rig().base_from_camera;
  rig.has_extrinsics = rig.has_wheels = rig.has_imu = true;
  if (request.kind == "slam") {
    if (map.keyframes.empty()) {
      throw maps::InputError(
          request.map_name +
          ": has no keyframes to localise in; use --pose odometry, perturbed or truth");
    }
    return slam_poses(config.slam, rig, map, request.start);
  }
  if (request.kind == "truth") return true_poses(simulator, world_from_map);
  if (request.kind == "perturbed") {
    return perturbed_poses(simulator, world_from_map, scenario, request.seed);
  }
  return odometry_poses(config.slam, rig, map.grid, request.start);
}

bool needs_camera(const std::string& pose_kind) {
  return pose_kind == "slam" || pose_kind == "odometry";
}

bool finds_itself(const std::string& pose_kind) { return pose_kind == "slam"; }

}  // namespace rovigo::app
