#pragma once
// What speaks for and against a pose in a saved map, and the confidence that follows from it.

#include <array>

namespace rovigo::slam {

/// All there is to say about the current pose.
struct LocalizerEvidence {
  int inliers = 0;             ///< of frames that matched, earlier ones fading; on what tells
                               ///< places apart
  double matched_share = 0.0;  ///< of the landmarks at their depth, how many matched
  double depth_share = 1.0;    ///< DepthAgreement::share(), with enough to judge
  double scan_share = 1.0;     ///< of the local scan, how much fits the grid
  double surface_share = 1.0;  ///< of what keyframes saw there, how much the views show
  double shape_margin = 0.0;   ///< PlaceCandidate::shape(), less that at the best other place
  int scan_points = 0;
  int agreeing_frames = 0;    ///< since the place was recognised
  double recognitions = 0.0;  ///< by appearance over the whole map, sum of their weights
  double rival_share = 0.0;   ///< what speaks for the best other place, as a share of that
  double sigma_position_m = 0.0;
  double sigma_heading_rad = 0.0;
  double unseen_s = 0.0;  ///< since the last frame that matched
};

/// A pose less likely to be right than this is not OK.
inline constexpr double kOkConfidence = 0.995;

/// The chance that the pose is within 0.20 m and 10 deg: logistic in the evidence, times the chance
/// that dead reckoning since the last look stayed within them. The weights were chosen by hand and
/// then scaled and shifted to the frequencies seen in three random worlds (Platt 1999), which
/// tests/benchmark/slam_localize/fit_confidence.py does; slam_localize prints the curve for others.
double confidence_of(const LocalizerEvidence& evidence);

/// The chance that a Gaussian error stays within what makes a pose right (0.20 m, 10 deg).
/// `sigma_position_m`: of the horizontal position, both axes together.
double chance_within_limits(double sigma_position_m, double sigma_heading_rad);

/// The inputs of the logistic model, first the constant 1; for the fit.
inline constexpr std::size_t kConfidenceFeatures = 13;
std::array<double, kConfidenceFeatures> confidence_features(const LocalizerEvidence& evidence);

}  // namespace rovigo::slam
