#include "slam/back_end.h"

#include "slam/bundle_adjustment.h"
#include "slam/heap.h"
#include "slam/keyframe_uncertainty.h"

namespace rovigo::slam {

std::optional<Se3> BackEnd::add_newest(const std::vector<MotionLink>& links,
                                       const LoopUncertainty& uncertainty) {
  const int newest = static_cast<int>(map_.keyframes().size()) - 1;
  for (const PoseGraphEdge& e : tracked_edges(map_, newest, on_floor_)) edges_.push_back(e);
  const auto loop = loops_.detect(map_, uncertainty);
  if (!loop || !config_.loop.loop_closure) return std::nullopt;
  const Se3 before = map_.keyframe(newest).map_from_base;
  if (!close_loop(map_, edges_, links, *loop)) return std::nullopt;
  ++loop_closures_;
  share_certainty(loop->edge.from, map_);
  return map_.keyframe(newest).map_from_base * before.inverse();
}

void BackEnd::cull(const Culling& culling) {
  rehang_edges(map_, culling, edges_);
  loops_.remove(culling.keyframe);
}

void BackEnd::adjust_everything(const std::vector<MotionLink>& links) {
  constexpr int kPasses = 2;  // the second without the sightings the first found wanting
  constexpr int kIterations = 8;
  for (int pass = 0; pass < kPasses; ++pass) {
    give_back_free_memory();  // the adjustment is the greatest moment of all
    adjust_bundle(map_, {}, links, {.iterations = kIterations, .on_floor = on_floor_});
  }
  give_back_free_memory();
}

}  // namespace rovigo::slam
