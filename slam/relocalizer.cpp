#include "slam/relocalizer.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr std::size_t kRanked = 60;  // looked at; the region and the exclusions thin them out
constexpr int kTried = 3;            // by geometry, which costs milliseconds each
constexpr std::size_t kAround = 8;   // keyframes whose landmarks join the guided matching
constexpr int kMinShared = 15;
constexpr int kAlikeBits = 48;  // of 256
constexpr double kElsewhereM = 0.5;

}  // namespace

bool PoseRegion::contains(const Se3& pose) const {
  const double distance = (pose.translation - map_from_base.translation).head<2>().norm();
  const double turn = maps::wrap_angle(to_planar(pose).phi - to_planar(map_from_base).phi);
  return distance <= radius_m && std::abs(turn) <= heading_rad;
}

namespace {

/// The keyframe need not lie inside the region, but must be able to show what it sees.
bool may_show(const PoseRegion& region, const Se3& keyframe) {
  PoseRegion wide = region;
  wide.radius_m += 1.5;
  wide.heading_rad += 0.9;
  return wide.contains(keyframe);
}

}  // namespace

Relocalizer::Relocalizer(const LandmarkMap& map) {
  for (const Keyframe& k : map.keyframes()) {
    if (!k.culled()) add(map, k.id);
  }
}

void Relocalizer::add(const LandmarkMap& map, int keyframe) {
  const Keyframe& k = map.keyframe(keyframe);
  std::vector<Descriptor> descriptors;
  std::vector<int> landmarks;
  for (std::size_t i = 0; i < k.features.size(); ++i) {
    if (k.landmark_of[i] < 0) continue;
    descriptors.push_back(k.features.descriptor(i));
    landmarks.push_back(k.landmark_of[i]);
  }
  const std::vector<int> numbers = index_.add(keyframe, descriptors);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<std::size_t>(numbers[i]);
    if (landmark_of_.size() <= number) landmark_of_.resize(number + 1, -1);
    landmark_of_[number] = landmarks[i];
  }
}

std::vector<bool> Relocalizer::repeated_landmarks(const LandmarkMap& map) const {
  std::vector<bool> repeated(map.landmarks().size(), false);
  for (std::size_t l = 0; l < repeated.size(); ++l) {
    const Landmark& a = map.landmark(static_cast<int>(l));
    if (!a.alive) continue;
    const auto alike = index_.similar(a.descriptor, kAlikeBits);
    repeated[l] = std::any_of(alike.begin(), alike.end(), [&](int d) {
      const Landmark& b = map.landmark(landmark_of_[static_cast<std::size_t>(d)]);
      return (a.position_map - b.position_map).norm() > kElsewhereM;
    });
  }
  return repeated;
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
    if (region && !may_show(*region, map.keyframe(s.view).map_from_base)) continue;
    ++tried;
    const PlaceMatch found = match(map, s.view, features, on_floor, config);
    if (region && !region->contains(found.solution.map_from_base)) continue;
    if (found.accepted && found.solution.inliers > best.match.solution.inliers) {
      best.match = found;
      best.keyframe = s.view;
    }
  }
  return best;
}

PlaceMatch Relocalizer::match(const LandmarkMap& map, int keyframe, const FeatureSet& features,
                              bool on_floor, const PlaceMatchConfig& config) const {
  std::vector<int> around{keyframe};
  for (const auto& [id, shared] : map.covisible(keyframe, kMinShared)) {
    if (around.size() >= kAround) break;
    around.push_back(id);
  }
  return match_place(map, map.landmarks_of({keyframe}), map.landmarks_of(around), features,
                     on_floor, config);
}

std::vector<Relocalization> Relocalizer::find_places(const LandmarkMap& map,
                                                     const FeatureSet& features, bool on_floor,
                                                     const std::optional<PoseRegion>& region,
                                                     int tries,
                                                     const PlaceMatchConfig& config) const {
  std::vector<Relocalization> places;
  std::vector<int> shown;  // by a place accepted already
  int tried = 0;
  for (const AppearanceScore& s : index_.query(features.descriptors(), kRanked)) {
    if (tried >= tries) break;
    if (std::find(shown.begin(), shown.end(), s.view) != shown.end()) continue;
    if (region && !may_show(*region, map.keyframe(s.view).map_from_base)) continue;
    ++tried;
    Relocalization found{match(map, s.view, features, on_floor, config), s.view};
    if (!found.match.accepted) continue;
    if (region && !region->contains(found.match.solution.map_from_base)) continue;
    for (const auto& [id, shared] : map.covisible(s.view, kMinShared)) shown.push_back(id);
    places.push_back(std::move(found));
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
    return a.match.solution.inliers > b.match.solution.inliers;
  });
  return places;
}

}  // namespace rovigo::slam
