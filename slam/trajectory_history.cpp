#include "slam/trajectory_history.h"

#include <Eigen/Geometry>

namespace rovigo::slam {

Se3 TrajectoryHistory::Entry::keyframe_from_base() const {
  const Eigen::Quaternionf q(rotation_xyzw[3], rotation_xyzw[0], rotation_xyzw[1],
                             rotation_xyzw[2]);
  return {q.cast<double>().normalized().toRotationMatrix(),
          Eigen::Vector3f(translation.data()).cast<double>()};
}

void TrajectoryHistory::Entry::set(const Se3& keyframe_from_base) {
  Eigen::Vector3f::Map(translation.data()) = keyframe_from_base.translation.cast<float>();
  Eigen::Vector4f::Map(rotation_xyzw.data()) =
      Eigen::Quaterniond(keyframe_from_base.rotation).coeffs().cast<float>();
}

Se3 TrajectoryHistory::pose_of(const Entry& entry, const LandmarkMap& map) {
  if (entry.keyframe < 0) return entry.keyframe_from_base();
  return map.keyframe(entry.keyframe).map_from_base * entry.keyframe_from_base();
}

void TrajectoryHistory::add(double time_s, int keyframe, const Se3& keyframe_from_base,
                            bool is_camera_frame) {
  // A look at the world replaces what was dead-reckoned for the same moment.
  constexpr double kSameMomentS = 0.01;
  if (is_camera_frame && !entries_.empty() && !entries_.back().is_camera_frame &&
      time_s - entries_.back().time_s < kSameMomentS) {
    entries_.pop_back();
  }
  if (entries_.size() == entries_.capacity()) {
    entries_.reserve(entries_.size() + entries_.size() / 8 + 1024);
  }
  Entry& e = entries_.emplace_back();
  e.time_s = time_s;
  e.keyframe = keyframe;
  e.is_camera_frame = is_camera_frame;
  e.set(keyframe_from_base);
}

void TrajectoryHistory::reanchor(double since_s, double until_s, const LandmarkMap& map,
                                 int keyframe, const Se3& new_map_from_old_map) {
  const Se3 keyframe_from_map = map.keyframe(keyframe).map_from_base.inverse();
  for (std::size_t i = entries_.size(); i-- > 0 && entries_[i].time_s >= since_s;) {
    Entry& e = entries_[i];
    if (e.time_s >= until_s) continue;
    const Se3 old = pose_of(e, map);
    e.keyframe = keyframe;
    e.set(keyframe_from_map * new_map_from_old_map * old);
  }
}

std::vector<maps::StoredPose> TrajectoryHistory::poses(const LandmarkMap& map) const {
  std::vector<maps::StoredPose> out;
  out.reserve(entries_.size());
  for (const Entry& e : entries_) {
    out.push_back({e.time_s, to_mrpt(normalized(pose_of(e, map))), e.is_camera_frame});
  }
  return out;
}

}  // namespace rovigo::slam
