#pragma once
// One camera frame against the landmarks around it: guided matching, then the robust pose.

#include <vector>

#include "slam/landmark_map.h"
#include "slam/motion_model.h"
#include "slam/pose_optimizer.h"

namespace rovigo::slam {

struct FeatureMatch {
  int landmark = -1;
  int feature = -1;
};

/// A landmark that falls into the view from a pose.
struct VisibleLandmark {
  int landmark = -1;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  int octave = 0;  ///< at which it should appear
};

/// Landmarks in front of the camera, inside the image, seen from about the side they were seen.
std::vector<VisibleLandmark> visible_landmarks(const LandmarkMap& map,
                                               const std::vector<int>& landmarks,
                                               const Se3& map_from_base);

/// The most similar feature near each landmark's predicted place; one landmark a feature.
std::vector<FeatureMatch> match_by_projection(const LandmarkMap& map,
                                              const std::vector<VisibleLandmark>& visible,
                                              const FeatureSet& features, double radius_px);

/// What the optimiser needs of each match: place and noise, with the landmark's own uncertainty
/// and `smear_px`, what turning does to the image, in it.
std::vector<PointObservation> observations_of(const LandmarkMap& map,
                                              const std::vector<FeatureMatch>& matches,
                                              const FeatureSet& features, const Se3& map_from_base,
                                              double smear_px);

enum class TrackStatus { kTracked, kTooFewMatches, kImplausible };

struct TrackResult {
  TrackStatus status = TrackStatus::kTooFewMatches;
  PoseSolution solution;
  std::vector<FeatureMatch> matches;  ///< inliers only
  std::vector<int> visible;           ///< landmarks that should have been seen
};

/// Finds the frame's pose from `prediction` and the local landmarks.
TrackResult track_frame(const LandmarkMap& map, const std::vector<int>& local_landmarks,
                        const FeatureSet& features, const MotionPrediction& prediction);

}  // namespace rovigo::slam
