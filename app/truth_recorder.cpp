#include "app/truth_recorder.h"

#include <cmath>

#include "maps/ros_map.h"

namespace rovigo::app {

using mrpt::poses::CPose3D;

TruthRecorder::TruthRecorder(const sim::World& world, const sim::Simulator& simulator,
                             const slam::GridConfig& grid)
    : simulator_(simulator),
      seen_(world, grid.grid_resolution_m, grid.obstacle_min_height_m, grid.obstacle_max_height_m) {
}

void TruthRecorder::frame(double time_s) {
  const CPose3D world_from_base = simulator_.truth().world_from_base;
  if (base_.empty()) world_from_map_ = world_from_base;
  const CPose3D map_from_base = world_from_base - world_from_map_;
  base_.push_back({time_s, map_from_base});
  camera_.push_back({time_s, map_from_base + simulator_.rig().base_from_camera});
  if (simulator_.truth().camera_blind) return;  // a covered camera sees no surface
  if (camera_has_seen_nothing_ || moved_since_last_view(world_from_base)) {
    seen_.add_view(world_from_base + simulator_.rig().base_from_camera, simulator_.rig().camera);
    last_view_ = world_from_base;
    camera_has_seen_nothing_ = false;
  }
}

bool TruthRecorder::moved_since_last_view(const CPose3D& world_from_base) const {
  // Views from nearly the same place show the same surfaces; casting them again buys nothing.
  constexpr double kDistanceM = 0.10;
  constexpr double kAngleRad = 0.10;
  return world_from_base.distanceTo(last_view_) > kDistanceM ||
         std::abs(maps::wrap_angle(world_from_base.yaw() - last_view_.yaw())) > kAngleRad;
}

void TruthRecorder::write(const std::filesystem::path& folder) const {
  std::filesystem::create_directories(folder);
  slam::write_tum_trajectory(folder / "groundtruth.txt", "map_from_camera", camera_);
  slam::write_tum_trajectory(folder / "base_groundtruth.txt", "map_from_base_link", base_);
  maps::save_ros_map(seen_.grid(), folder / "world_grid.yaml");
}

}  // namespace rovigo::app
