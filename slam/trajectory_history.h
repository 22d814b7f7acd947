#pragma once
// Every pose of a run, held relative to a keyframe so that it follows what the back end decides.

#include <vector>

#include "maps/map_file.h"
#include "slam/landmark_map.h"

namespace rovigo::slam {

class TrajectoryHistory {
 public:
  /// `keyframe` may be -1 while there is none; the pose is then taken as it is.
  void add(double time_s, int keyframe, const Se3& keyframe_from_base, bool is_camera_frame);
  /// Poses of [since_s, until_s) were off by one motion: `new_map_from_old_map` mends them, and
  /// from now on they follow `keyframe`.
  void reanchor(double since_s, double until_s, const LandmarkMap& map, int keyframe,
                const Se3& new_map_from_old_map);
  double last_time_s() const { return entries_.empty() ? -1.0 : entries_.back().time_s; }

  /// In the map frame as the keyframes are now.
  std::vector<maps::StoredPose> poses(const LandmarkMap& map) const;

 private:
  struct Entry {
    double time_s = 0.0;
    int keyframe = -1;
    Se3 keyframe_from_base;
    bool is_camera_frame = true;
  };
  std::vector<Entry> entries_;
};

}  // namespace rovigo::slam
