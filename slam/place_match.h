#pragma once
// Geometry's verdict on a suspected place: do this view's features fit those landmarks as one
// rigid scene? Used to recover, to close loops and to find the start in a saved map.

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/tracker.h"

namespace rovigo::slam {

struct PlaceMatchConfig {
  int min_inliers = 25;
  double min_inlier_share = 0.35;  ///< of the guided matches
  double min_upright_share = 0.4;  ///< of min_inliers, on what stands upright; on the floor only
  std::uint64_t seed = 1;          ///< of the random samples
};

/// Floors and ceilings repeat themselves, tile by tile, and show no place; what stands upright
/// does. By height, which is all a landmark has.
bool is_upright(const Landmark& landmark);

struct PlaceMatch {
  bool accepted = false;
  PoseSolution solution;
  std::vector<FeatureMatch> matches;  ///< inliers only
  int appearance_matches = 0;         ///< before geometry; on the floor, those at their height
  int upright_inliers = 0;            ///< of the solution's, on what stands upright
  int sample_inliers = 0;             ///< that agreed with the best random sample
};

/// Appearance alone: each landmark's most similar feature in the whole view, if clearly so.
std::vector<FeatureMatch> match_by_appearance(const LandmarkMap& map,
                                              const std::vector<int>& landmarks,
                                              const FeatureSet& features);

/// `core`: landmarks of the suspected place, matched by appearance and fitted by RANSAC over
/// triples of 3D points (pairs on the floor); `wide`: landmarks around it, matched by the pose
/// found. `on_floor` keeps a rover on its plane.
PlaceMatch match_place(const LandmarkMap& map, const std::vector<int>& core,
                       const std::vector<int>& wide, const FeatureSet& features, bool on_floor,
                       const PlaceMatchConfig& config);

/// Least-squares rigid motion between paired points (Umeyama 1991, without scale):
/// target = result * source. Needs three or more pairs that are not in line.
std::optional<Se3> fit_rigid(const std::vector<Eigen::Vector3d>& source,
                             const std::vector<Eigen::Vector3d>& target);

}  // namespace rovigo::slam
