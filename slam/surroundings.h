#pragma once
// What the depth camera saw of the ground on the way, kept as evidence that follows the keyframes.

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/camera_frame.h"
#include "slam/depth_filter.h"
#include "slam/depth_scan.h"
#include "slam/evidence_patch.h"
#include "slam/floor_depth.h"
#include "slam/floor_tracker.h"
#include "slam/landmark_map.h"
#include "slam/motion_watch.h"
#include "slam/ray_voter.h"

namespace rovigo::slam {

/// Built online: each frame adds to the evidence of one patch, and the grid can be rendered at any
/// time from the poses the keyframes then have. A patch serves all keyframes close to the one it
/// hangs on, so memory grows with the space seen and not with the time spent in it.
class Surroundings {
 public:
  /// `on_floor`: the camera's height over the floor is known; otherwise evidence is taken from the
  /// keyframes in the end, when the floor can be estimated.
  Surroundings(const SlamConfig& config, const CameraModel& camera, const Se3& base_from_camera,
               bool on_floor);

  /// Adds what a frame shows, relative to `keyframe`, whenever the view has changed a little.
  void look(const CameraFrame& frame, const LandmarkMap& map, int keyframe, const Se3& pose);

  /// The grid, from the poses as the keyframes are now.
  maps::OccupancyGrid render(const LandmarkMap& map);
  /// The same halfway: without the newest looks, of which nobody knows yet what in them moves.
  /// Empty off the floor.
  maps::OccupancyGrid grid_so_far(const LandmarkMap& map) const;

  /// The floor as the camera has seen it so far, against what the mount says.
  const FloorPlane& floor() const { return floor_.plane(); }
  /// The same for the depths of a frame, which teaches it as long as it is hardly known. Nothing
  /// while it is not, and for a camera that nobody knows the height of.
  std::optional<FloorDepth> floor_under(const CameraFrame& frame);

  std::size_t memory_bytes() const;

 private:
  struct AnchoredPatch {
    int keyframe = 0;
    TPose2D keyframe_from_patch;
    EvidencePatch evidence;
  };

  /// A scan that waits until what came after it has told what of it moved.
  struct PendingLook {
    AnchoredView view;
    std::size_t patch = 0;
    TPose2D patch_from_level;
    DepthScanner::Samples samples;
    double depth_unit_m = 0.0;
  };

  void cast_votes_until(double time_s, const LandmarkMap& map);
  std::size_t patch_of(const LandmarkMap& map, int keyframe);
  std::size_t nearby_patch(const LandmarkMap& map, int keyframe) const;
  void add_keyframes(const LandmarkMap& map);
  void follow_floor(const DepthScanner::Samples& samples, double depth_unit_m);

  SlamConfig config_;
  CameraModel camera_;
  Se3 base_from_camera_;
  bool on_floor_;
  DepthFilter filter_;
  DepthScanner scanner_;
  RayVoter voter_;
  FloorTracker floor_;
  MotionWatch watch_;
  std::deque<PendingLook> pending_;
  std::vector<AnchoredPatch> patches_;
  std::map<int, std::size_t> patch_of_keyframe_;
  int last_keyframe_ = -1;
  Se3 last_pose_;   ///< of the last look
  Se3 frame_pose_;  ///< of the last frame
  int rested_frames_ = 0;
};

}  // namespace rovigo::slam
