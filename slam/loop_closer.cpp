#include "slam/loop_closer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr int kRecent = 12;       // keyframes just passed are no loop
constexpr int kSharedEnough = 8;  // landmarks in common: tied together already
constexpr int kRelatives = 3;
constexpr int kRelativeShared = 40;
constexpr int kTiedShared = 15;  // fewer landmarks in common with the last one: not tied by them
constexpr double kLoopFloorM = 0.006;
constexpr double kLoopFloorRad = 0.003;
constexpr double kFalseLoopChi2 = 60.0;  // six degrees of freedom: far beyond any honest error
constexpr int kIterations = 20;

Matrix6d edge_information(const Se3& step, bool on_floor) {
  const double distance = step.translation.norm();
  const double turn = so3_log(step.rotation).norm();
  Vector6d sigma;
  const double free_motion = on_floor ? 1.0 : 2.0;
  sigma.head<3>().setConstant(free_motion * (0.004 + 0.004 * distance));
  sigma.tail<3>().setConstant(free_motion * (0.002 + 0.004 * turn));
  if (on_floor) sigma(2) = sigma(3) = sigma(4) = 0.002;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

}  // namespace

std::optional<LoopClosure> LoopCloser::detect(const LandmarkMap& map,
                                              const LoopUncertainty& uncertainty) {
  const int id = static_cast<int>(map.keyframes().size()) - 1;
  const Keyframe& k = map.keyframe(id);
  std::vector<int> excluded;
  for (int i = std::max(0, id - kRecent); i <= id; ++i) excluded.push_back(i);
  for (const auto& [other, shared] : map.covisible(id, kSharedEnough)) excluded.push_back(other);
  const PoseRegion region{k.map_from_base,
                          config_.loop.loop_search_radius_m + 3.0 * uncertainty.sigma_position_m,
                          on_floor_ ? 0.35 + 3.0 * uncertainty.sigma_heading_rad : maps::kPi};
  const Relocalization found = relocalizer_.find(
      map, k.features, on_floor_, region, excluded,
      {.min_inliers = config_.loop.min_loop_inliers, .seed = static_cast<std::uint64_t>(id)});
  relocalizer_.add(map, id);
  if (found.keyframe < 0) return std::nullopt;

  LoopClosure loop;
  loop.matches = found.match.matches;
  loop.edge.from = found.keyframe;
  loop.edge.to = id;
  loop.edge.kind = maps::StoredEdge::Kind::kLoop;
  loop.edge.from_from_to =
      map.keyframe(found.keyframe).map_from_base.inverse() * found.match.solution.map_from_base;
  Vector6d floor_variance;
  floor_variance.head<3>().setConstant(kLoopFloorM * kLoopFloorM);
  floor_variance.tail<3>().setConstant(kLoopFloorRad * kLoopFloorRad);
  const Matrix6d covariance = found.match.solution.information.inverse();
  loop.edge.information = (covariance + Matrix6d(floor_variance.asDiagonal())).inverse();
  return loop;
}

std::vector<PoseGraphEdge> tracked_edges(const LandmarkMap& map, int keyframe, bool on_floor) {
  std::vector<PoseGraphEdge> edges;
  const auto add = [&](int other) {
    PoseGraphEdge e;
    e.from = other;
    e.to = keyframe;
    e.from_from_to =
        map.keyframe(other).map_from_base.inverse() * map.keyframe(keyframe).map_from_base;
    e.information = edge_information(e.from_from_to, on_floor);
    edges.push_back(e);
  };
  for (const auto& [other, shared] : map.covisible(keyframe, kTiedShared)) {
    const bool before = other == keyframe - 1;
    const bool relative = shared >= kRelativeShared && static_cast<int>(edges.size()) <= kRelatives;
    if (before || relative) add(other);
  }
  return edges;
}

bool close_loop(LandmarkMap& map, std::vector<PoseGraphEdge>& edges,
                const std::vector<MotionLink>& links, const LoopClosure& loop) {
  PoseGraph graph{{}, edges, links};
  for (const Keyframe& k : map.keyframes()) graph.poses.push_back(k.map_from_base);
  graph.edges.push_back(loop.edge);
  const PoseGraphResult result =
      optimize_pose_graph(graph, map.config().dead_reckoning, kIterations);
  if (!result.converged || result.edge_chi2.back() > kFalseLoopChi2) return false;

  edges = std::move(graph.edges);
  map.move_keyframes(result.poses);
  for (const FeatureMatch& m : loop.matches) {
    const int present = map.keyframe(loop.edge.to).landmark_of[static_cast<std::size_t>(m.feature)];
    if (present < 0) {
      map.add_sighting(m.landmark, loop.edge.to, m.feature);
    } else {
      map.merge_landmarks(present, m.landmark);
    }
  }
  return true;
}

}  // namespace rovigo::slam
