#pragma once
// Simultaneous localisation and mapping from a stream of observations.

#include <mrpt/obs/CObservation.h>

#include <memory>
#include <optional>

#include "maps/map_file.h"
#include "slam/pose_estimate.h"
#include "slam/rig.h"
#include "slam/slam_config.h"

namespace rovigo::slam {

/// Counters of a finished run; the command line prints them.
struct SlamSummary {
  int camera_frames = 0;
  int tracked_frames = 0;  ///< health OK
  int keyframes = 0;
  int loop_closures = 0;
  /// The floor the camera saw against the mount's word: its height, its tilt, and by how many
  /// looks.
  double floor_height_m = 0.0, floor_tilt_rad = 0.0;
  int floor_looks = 0;
};

/// Feed it every observation in time order (CObservation3DRangeScan, CObservationIMU,
/// CObservationOdometry); it never looks at a clock. Work beside the frame loop is scheduled by
/// frame count, so that the same recording gives the same map for any thread count.
class Slam {
 public:
  Slam(const SlamConfig& config, const Rig& rig);
  ~Slam();

  /// Takes one observation in. For a camera frame: the pose now, in the map frame as known so far.
  /// A rover whose frames stay out gets its dead-reckoned pose, never called OK, for every reading.
  std::optional<PoseEstimate> process(const mrpt::obs::CObservation& observation);

  /// Optimises once more, renders the grid from the optimised poses and hands the map over
  /// (metadata's recording and simulation fields are the caller's to fill).
  maps::SavedMap finish();

  SlamSummary summary() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rovigo::slam
