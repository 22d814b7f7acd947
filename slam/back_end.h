#pragma once
// What holds the keyframes together: measured edges, loops closed, and the last adjustment.

#include <optional>
#include <vector>

#include "slam/keyframe_culling.h"
#include "slam/landmark_map.h"
#include "slam/loop_closer.h"

namespace rovigo::slam {

class BackEnd {
 public:
  /// `map` must outlive this.
  BackEnd(const SlamConfig& config, LandmarkMap& map, bool on_floor)
      : config_(config), map_(map), on_floor_(on_floor), loops_(config, on_floor) {}

  /// Ties the newest keyframe to its relatives as tracked, and to a place seen long ago where it
  /// shows one. The result is how a closed loop moved the newest keyframe
  /// (new_map_from_old_map). `links`: everything that ties keyframes but corners.
  std::optional<Se3> add_newest(const std::vector<MotionLink>& links,
                                const LoopUncertainty& uncertainty);

  /// A keyframe goes: loops and neighbours hang on its host, and it is not recognised any more.
  void cull(const Culling& culling);

  /// Nothing will be recognised from now on: the index of places is let go of.
  void forget_places() { loops_.forget_places(); }

  /// The last word on all poses: everything seen, all at once. `revisits` are links that the poses
  /// do not know of yet.
  void adjust_everything(std::vector<MotionLink> links, const std::vector<MotionLink>& revisits);

  const std::vector<PoseGraphEdge>& edges() const { return edges_; }
  const Relocalizer& relocalizer() const { return loops_.relocalizer(); }
  int loop_closures() const { return loop_closures_; }

 private:
  /// Over the graph alone: the adjustment of everything goes no long ways.
  void spread(const std::vector<MotionLink>& links);

  SlamConfig config_;
  LandmarkMap& map_;
  bool on_floor_;
  LoopCloser loops_;
  std::vector<PoseGraphEdge> edges_;
  int loop_closures_ = 0;
};

}  // namespace rovigo::slam
