#pragma once
// Places seen before: recognised, checked, and tied into the pose graph.

#include <optional>
#include <vector>

#include "slam/landmark_map.h"
#include "slam/pose_graph.h"
#include "slam/relocalizer.h"

namespace rovigo::slam {

struct LoopUncertainty {
  double sigma_position_m = 0.0;  ///< of the pose now, against the map's older part
  double sigma_heading_rad = 0.0;
};

struct LoopClosure {
  PoseGraphEdge edge;  ///< from the place recognised to the new keyframe
  std::vector<FeatureMatch> matches;
};

class LoopCloser {
 public:
  LoopCloser(const SlamConfig& config, bool on_floor) : config_(config), on_floor_(on_floor) {}

  /// Looks for the newest keyframe among the older ones, then adds it to the index.
  std::optional<LoopClosure> detect(const LandmarkMap& map, const LoopUncertainty& uncertainty);

  /// A keyframe that was culled is not recognised any more.
  void remove(int keyframe) { relocalizer_.remove(keyframe); }
  void forget_places() { relocalizer_ = Relocalizer(); }

  const Relocalizer& relocalizer() const { return relocalizer_; }

 private:
  SlamConfig config_;
  bool on_floor_;
  Relocalizer relocalizer_;
};

/// What the camera says of a new keyframe: edges to the one before it, where both see the same
/// things, and to its closest relatives, as tracked.
std::vector<PoseGraphEdge> tracked_edges(const LandmarkMap& map, int keyframe, bool on_floor);

/// Optimises the graph with the loop in it. True: it agrees with the rest; the map has moved and
/// the landmarks of both views are one. False: the loop was false and nothing has changed.
bool close_loop(LandmarkMap& map, std::vector<PoseGraphEdge>& edges,
                const std::vector<MotionLink>& links, const LoopClosure& loop);

}  // namespace rovigo::slam
