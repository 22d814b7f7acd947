#include "slam/local_map.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr std::size_t kObservers = 10;  // keyframes that see what is tracked
constexpr std::size_t kRelatives = 4;   // and of the reference's neighbours
constexpr int kMinShared = 15;
constexpr std::size_t kAny = 20;  // features; fewer cannot be recognised

void add_unique(std::vector<int>& list, int id) {
  if (std::find(list.begin(), list.end(), id) == list.end()) list.push_back(id);
}

std::vector<int> nearest_keyframes(const LandmarkMap& map, const Se3& map_from_base) {
  std::vector<std::pair<double, int>> ranked;
  for (const Keyframe& k : map.keyframes()) {
    if (k.features.size() < kAny) continue;
    ranked.emplace_back(keyframe_spacing(k.map_from_base, map_from_base, map.config().tracking),
                        k.id);
  }
  const std::size_t n = std::min(ranked.size(), kObservers);
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(n), ranked.end());
  std::vector<int> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(ranked[i].second);
  return out;
}

}  // namespace

double keyframe_spacing(const Se3& a, const Se3& b, const TrackingConfig& config) {
  const double distance = (a.translation - b.translation).norm();
  const double angle = so3_log(a.rotation.transpose() * b.rotation).norm();
  return distance / config.keyframe_distance_m + angle / config.keyframe_angle_rad;
}

LocalMap select_local_map(const LandmarkMap& map, const std::vector<int>& tracked_landmarks,
                          const Se3& map_from_base) {
  LocalMap local;
  if (map.keyframes().empty()) return local;
  const auto observers = map.observers(tracked_landmarks);
  if (observers.empty()) {
    local.keyframes = nearest_keyframes(map, map_from_base);
    if (local.keyframes.empty()) return local;
    local.reference_keyframe = local.keyframes.front();
  } else {
    local.reference_keyframe = observers.front().first;
    for (std::size_t i = 0; i < std::min(kObservers, observers.size()); ++i) {
      local.keyframes.push_back(observers[i].first);
    }
    const auto relatives = map.covisible(local.reference_keyframe, kMinShared);
    for (std::size_t i = 0; i < std::min(kRelatives, relatives.size()); ++i) {
      add_unique(local.keyframes, relatives[i].first);
    }
  }
  local.landmarks = map.landmarks_of(local.keyframes);
  return local;
}

namespace {

double nearest_spacing(const LandmarkMap& map, const LocalMap& local, const Se3& map_from_base) {
  double nearest = 1e9;
  for (const int k : local.keyframes) {
    nearest = std::min(nearest, keyframe_spacing(map.keyframe(k).map_from_base, map_from_base,
                                                 map.config().tracking));
  }
  return nearest;
}

}  // namespace

bool wants_keyframe(const LandmarkMap& map, const LocalMap& local, const TrackResult& result,
                    const FeatureSet& features, const Se3& map_from_base) {
  const TrackingConfig& config = map.config().tracking;
  const double nearest = nearest_spacing(map, local, map_from_base);
  const auto with_depth = std::count_if(features.features().begin(), features.features().end(),
                                        [](const Feature& f) { return f.depth_m > 0; });
  const double known = static_cast<double>(result.matches.size());
  const bool poor = known < config.keyframe_min_overlap * 0.5 * static_cast<double>(with_depth);
  return nearest > 1.0 || (poor && nearest > 0.3);
}

}  // namespace rovigo::slam
