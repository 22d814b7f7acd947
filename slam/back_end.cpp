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

void BackEnd::spread(const std::vector<MotionLink>& links) {
  constexpr int kIterations = 15;
  PoseGraph graph{{}, edges_, links};
  for (const Keyframe& k : map_.keyframes()) graph.poses.push_back(k.map_from_base);
  const PoseGraphResult result = optimize_pose_graph(graph, config_.dead_reckoning, kIterations);
  if (result.converged) map_.move_keyframes(result.poses);
}

void BackEnd::adjust_everything(std::vector<MotionLink> links,
                                const std::vector<MotionLink>& revisits) {
  constexpr int kPasses = 2;  // the second without the sightings the first found wanting
  constexpr int kIterations = 8;
  links.insert(links.end(), revisits.begin(), revisits.end());
  if (!revisits.empty()) spread(links);
  for (int pass = 0; pass < kPasses; ++pass) {
    give_back_free_memory();  // the adjustment is the greatest moment of all
    adjust_bundle(map_, {}, links, {.iterations = kIterations, .on_floor = on_floor_});
  }
  give_back_free_memory();
}

}  // namespace rovigo::slam
