#include "slam/relocalizer.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr std::size_t kRanked = 60;  // looked at; the region and the exclusions thin them out
constexpr int kTried = 3;            // by geometry, which costs milliseconds each
constexpr std::size_t kAround = 8;   // keyframes whose landmarks join the guided matching
constexpr int kMinShared = 15;

}  // namespace

bool PoseRegion::contains(const Se3& pose) const {
  const double distance = (pose.translation - map_from_base.translation).head<2>().norm();
  const double turn = maps::wrap_angle(to_planar(pose).phi - to_planar(map_from_base).phi);
  return distance <= radius_m && std::abs(turn) <= heading_rad;
}

void Relocalizer::add(const LandmarkMap& map, int keyframe) {
  const Keyframe& k = map.keyframe(keyframe);
  std::vector<Descriptor> descriptors;
  for (std::size_t i = 0; i < k.features.size(); ++i) {
    if (k.landmark_of[i] >= 0) descriptors.push_back(k.features.descriptor(i));
  }
  index_.add(keyframe, descriptors);
}

Relocalization Relocalizer::find(const LandmarkMap& map, const FeatureSet& features, bool on_floor,
                                 const std::optional<PoseRegion>& region,
                                 const std::vector<int>& excluded,
                                 const PlaceMatchConfig& config) const {
  Relocalization best;
  int tried = 0;
  for (const AppearanceScore& s : index_.query(features.descriptors(), kRanked)) {
    if (tried >= kTried) break;
    if (std::find(excluded.begin(), excluded.end(), s.view) != excluded.end()) continue;
    if (region) {
      // The keyframe need not lie inside the region, but must be able to show what it sees.
      PoseRegion wide = *region;
      wide.radius_m += 1.5;
      wide.heading_rad += 0.9;
      if (!wide.contains(map.keyframe(s.view).map_from_base)) continue;
    }
    ++tried;
    std::vector<int> around{s.view};
    for (const auto& [id, shared] : map.covisible(s.view, kMinShared)) {
      if (around.size() >= kAround) break;
      around.push_back(id);
    }
    const PlaceMatch match = match_place(map, map.landmarks_of({s.view}), map.landmarks_of(around),
                                         features, on_floor, config);
    if (region && !region->contains(match.solution.map_from_base)) continue;
    if (match.accepted && match.solution.inliers > best.match.solution.inliers) {
      best.match = match;
      best.keyframe = s.view;
    }
  }
  return best;
}

}  // namespace rovigo::slam
