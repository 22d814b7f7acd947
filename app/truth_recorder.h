#pragma once
// The truth beside a simulated recording, for the scorer only: poses and the surfaces that were
// seen.

#include <mrpt/poses/CPose3D.h>

#include <filesystem>
#include <vector>

#include "sim/simulator.h"
#include "slam/slam_config.h"
#include "slam/trajectory_file.h"

namespace rovigo::app {

class TruthRecorder {
 public:
  /// `simulator` must outlive this. The true grid takes the mapper's cell size and heights.
  TruthRecorder(const sim::World& world, const sim::Simulator& simulator,
                const slam::GridConfig& grid);

  /// Call at every camera frame, right after the simulator's step that made it.
  void frame(double time_s);

  /// groundtruth.txt (map_from_camera), base_groundtruth.txt (map_from_base_link), world_grid.yaml
  /// (world frame; occupied cells that the camera never saw are unknown).
  void write(const std::filesystem::path& folder) const;

 private:
  bool moved_since_last_view(const mrpt::poses::CPose3D& world_from_base) const;

  const sim::Simulator& simulator_;
  sim::SeenSurfaces seen_;
  mrpt::poses::CPose3D world_from_map_;
  mrpt::poses::CPose3D last_view_;
  bool camera_has_seen_nothing_ = true;
  std::vector<slam::StampedPose> base_;
  std::vector<slam::StampedPose> camera_;
};

}  // namespace rovigo::app
