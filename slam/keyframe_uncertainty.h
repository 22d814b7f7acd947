#pragma once
// How well keyframes are known against the map's first one, and so every pose held against them.

#include "slam/landmark_map.h"

namespace rovigo::slam {

// Of a pose found by recognising the place.
inline constexpr double kFoundSigmaM = 0.05;
inline constexpr double kFoundSigmaRad = 0.03;

/// What the map's own error adds to a pose. Planar covariances of (x, y, yaw) in the map frame add
/// up along the chain of keyframes (Smith, Self & Cheeseman 1990): an error of heading swings all
/// that comes after it.
class MapUncertainty {
 public:
  /// The frame at hand showed what `keyframe` saw: the map is as uncertain here as that one is.
  void see(const Keyframe& keyframe);
  /// Tells a new keyframe, made at its pose, how well it is known. `blind`: by dead reckoning
  /// alone, whose covariance since the last look is `reckoned`.
  void join(Keyframe& keyframe, const Eigen::Matrix3d& reckoned, bool blind);
  /// Of the map at a pose; what is known of the pose against the map comes on top.
  Eigen::Matrix3d at(const Se3& map_from_base) const;

 private:
  Se3 map_from_base_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  bool begun_ = false;
};

/// A loop was closed: the newest keyframe is known about as well as the place that was seen again,
/// and those on the way from there gain by it too.
void share_certainty(int seen_again, LandmarkMap& map);

}  // namespace rovigo::slam
