#pragma once
// Finding oneself in a known map: appearance proposes places, geometry decides.

#include <optional>
#include <vector>

#include "slam/appearance_index.h"
#include "slam/place_match.h"

namespace rovigo::slam {

/// A region that the pose is believed to lie in.
struct PoseRegion {
  Se3 map_from_base;
  double radius_m = 1.0;
  double heading_rad = 1.0;
  bool contains(const Se3& pose) const;
};

struct Relocalization {
  PlaceMatch match;
  int keyframe = -1;  ///< the place recognised; -1: none
};

class Relocalizer {
 public:
  Relocalizer() = default;
  /// Knows every keyframe of the map.
  explicit Relocalizer(const LandmarkMap& map);

  /// Adds a keyframe's descriptors (those with landmarks) to the index.
  void add(const LandmarkMap& map, int keyframe);
  /// A keyframe that was culled is not proposed any more.
  void remove(int keyframe) { index_.remove(keyframe); }

  /// Landmarks that look like another one somewhere else in the map: bricks, tiles, the same print
  /// in two rooms. They fit a pose, but say nothing about which place this is. By landmark id.
  std::vector<bool> repeated_landmarks(const LandmarkMap& map) const;

  /// Tries the most similar keyframes, inside `region` if given, leaving out `excluded`.
  Relocalization find(const LandmarkMap& map, const FeatureSet& features, bool on_floor,
                      const std::optional<PoseRegion>& region, const std::vector<int>& excluded,
                      const PlaceMatchConfig& config) const;

  /// Every place that geometry accepts among the most similar keyframes, the one with most inliers
  /// first. At most `tries` are looked at by geometry, each somewhere else: keyframes that show
  /// what an accepted one shows are passed over, so that look-alikes come to light.
  std::vector<Relocalization> find_places(const LandmarkMap& map, const FeatureSet& features,
                                          bool on_floor, const std::optional<PoseRegion>& region,
                                          int tries, const PlaceMatchConfig& config) const;

 private:
  PlaceMatch match(const LandmarkMap& map, int keyframe, const FeatureSet& features, bool on_floor,
                   const PlaceMatchConfig& config) const;

  AppearanceIndex index_;
  std::vector<int> landmark_of_;  ///< per number of a descriptor in the index
};

}  // namespace rovigo::slam
