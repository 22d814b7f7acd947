#pragma once
// Which keyframes the map can do without: their landmarks are seen by others from near by (as in
// Mur-Artal & Tardos 2017, section VI.E), so that revisiting a room adds nothing that stays.

#include <optional>
#include <vector>

#include "slam/landmark_map.h"
#include "slam/motion_link.h"
#include "slam/pose_graph.h"

namespace rovigo::slam {

struct Culling {
  int keyframe = -1;
  int host = -1;  ///< shows about the same from near by; what hung on `keyframe` goes to it
};

/// The most dispensable keyframe around the newest one; none while all of them are needed. The
/// first keyframe and the latest ones always stay.
std::optional<Culling> dispensable_keyframe(const LandmarkMap& map);

/// What tied `keyframe` to others ties its host to them: a loop may hang on it. A tie between two
/// that are tied already is dropped.
void rehang_edges(const LandmarkMap& map, const Culling& culling,
                  std::vector<PoseGraphEdge>& edges);

/// Likewise for wheels, gyro and walls; two links that met in the keyframe become one.
void rehang_links(const LandmarkMap& map, const Culling& culling, std::vector<MotionLink>& links);

/// `a`, then `b` from where it ended, under `a`'s calibration.
MotionLink chained(const MotionLink& a, const MotionLink& b);

}  // namespace rovigo::slam
