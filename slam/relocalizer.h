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
  /// Adds a keyframe's descriptors (those with landmarks) to the index.
  void add(const LandmarkMap& map, int keyframe);

  /// Tries the most similar keyframes, inside `region` if given, leaving out `excluded`.
  Relocalization find(const LandmarkMap& map, const FeatureSet& features, bool on_floor,
                      const std::optional<PoseRegion>& region, const std::vector<int>& excluded,
                      const PlaceMatchConfig& config) const;

 private:
  AppearanceIndex index_;
};

}  // namespace rovigo::slam
