#pragma once
// Every pose of a run, held relative to a keyframe so that it follows what the back end decides.

#include <array>
#include <cstdint>
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
  /// Fifty a second for hours: single precision, microns at a keyframe's distance, halves them.
  struct Entry {
    double time_s = 0.0;
    std::int32_t keyframe = -1;
    bool is_camera_frame = true;
    std::array<float, 3> translation{};
    std::array<float, 4> rotation_xyzw{0, 0, 0, 1};

    Se3 keyframe_from_base() const;
    void set(const Se3& keyframe_from_base);
  };
  static Se3 pose_of(const Entry& entry, const LandmarkMap& map);
  std::vector<Entry> entries_;
};

}  // namespace rovigo::slam
