#include "slam/trajectory_history.h"

namespace rovigo::slam {

void TrajectoryHistory::add(double time_s, int keyframe, const Se3& keyframe_from_base,
                            bool is_camera_frame) {
  // A look at the world replaces what was dead-reckoned for the same moment.
  constexpr double kSameMomentS = 0.01;
  if (is_camera_frame && !entries_.empty() && !entries_.back().is_camera_frame &&
      time_s - entries_.back().time_s < kSameMomentS) {
    entries_.pop_back();
  }
  entries_.push_back({time_s, keyframe, keyframe_from_base, is_camera_frame});
}

void TrajectoryHistory::reanchor(double since_s, double until_s, const LandmarkMap& map,
                                 int keyframe, const Se3& new_map_from_old_map) {
  const Se3 keyframe_from_map = map.keyframe(keyframe).map_from_base.inverse();
  for (std::size_t i = entries_.size(); i-- > 0 && entries_[i].time_s >= since_s;) {
    Entry& e = entries_[i];
    if (e.time_s >= until_s) continue;
    const Se3 old = e.keyframe < 0 ? e.keyframe_from_base
                                   : map.keyframe(e.keyframe).map_from_base * e.keyframe_from_base;
    e.keyframe = keyframe;
    e.keyframe_from_base = keyframe_from_map * new_map_from_old_map * old;
  }
}

std::vector<maps::StoredPose> TrajectoryHistory::poses(const LandmarkMap& map) const {
  std::vector<maps::StoredPose> out;
  out.reserve(entries_.size());
  for (const Entry& e : entries_) {
    const Se3 pose = e.keyframe < 0 ? e.keyframe_from_base
                                    : map.keyframe(e.keyframe).map_from_base * e.keyframe_from_base;
    out.push_back({e.time_s, to_mrpt(normalized(pose)), e.is_camera_frame});
  }
  return out;
}

}  // namespace rovigo::slam
