#pragma once
// What the depth camera saw of the ground on the way, kept until the poses are final.

#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/camera_frame.h"
#include "slam/depth_scan.h"
#include "slam/landmark_map.h"
#include "slam/trajectory_history.h"

namespace rovigo::slam {

class Surroundings {
 public:
  /// `on_floor`: the camera's height over the floor is known; otherwise scans are made from the
  /// keyframes in the end, when the floor can be estimated.
  Surroundings(const SlamConfig& config, const CameraModel& camera, const Se3& base_from_camera,
               bool on_floor);

  /// Keeps a flat scan, relative to `keyframe`, wherever the view has changed a little.
  void look(const CameraFrame& frame, const LandmarkMap& map, int keyframe, const Se3& pose);

  /// The grid, from the poses as the keyframes are now.
  maps::OccupancyGrid render(const LandmarkMap& map, const TrajectoryHistory& history);

 private:
  struct AnchoredScan {
    int keyframe = 0;
    Se3 keyframe_from_base;
    DepthScan scan;
  };

  SlamConfig config_;
  Se3 base_from_camera_;
  bool on_floor_;
  DepthScanner scanner_;
  std::vector<AnchoredScan> scans_;
  Se3 last_pose_;
};

}  // namespace rovigo::slam
