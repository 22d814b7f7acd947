#include "slam/localizer_evidence.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "maps/geometry.h"

namespace rovigo::slam {

namespace {

constexpr double kRightM = 0.20, kRightRad = 10.0 * maps::kPi / 180.0;
constexpr double kMostFrames = 30.0;  // more of them add nothing: they share their errors
constexpr double kMostRecognitions = 6.0;
constexpr double kMostTellingPoints = 10.0;
// Of features and shape together: enough of each.
constexpr double kJointInliers = 20.0, kFewScanPoints = 40.0, kJointPoints = 60.0;
constexpr double kJointMargin = 0.02, kJointRival = 0.3;

/// Points of the scan that this place explains and the best other one does not, less those that it
/// does not explain itself: a small margin says more the more points it comes from.
double telling_points(const LocalizerEvidence& e) {
  const double points = (e.shape_margin - (1.0 - e.scan_share)) * e.scan_points;
  return std::clamp(points, 0.0, kMostTellingPoints);
}

/// Textures repeat, and so do rooms, but hardly both in the same way: where features match and a
/// scan of many points fits no other place as well, the two together say more than their sum.
double joint_agreement(const LocalizerEvidence& e) {
  const double features = e.inliers / kJointInliers;
  const double points = (e.scan_points - kFewScanPoints) / kJointPoints;
  const double margin = e.shape_margin / kJointMargin;
  const double unrivalled = 1.0 - e.rival_share / kJointRival;
  return std::clamp(features, 0.0, 1.0) * std::clamp(points, 0.0, 1.0) *
         std::clamp(margin, 0.0, 1.0) * std::clamp(unrivalled, 0.0, 1.0);
}

// constant, log inliers, matched share, depth share, scan share, log frames, recognitions, rival,
// shape margin, log scan points, surface share, telling points,
// joint agreement
constexpr std::array<double, kConfidenceFeatures> kWeights = {
    -14.9, 0.42, 0.0, 1.05, 4.2, 1.05, 1.05, -5.25, 15.75, 0.53, 8.4, 0.2, 2.5};

}  // namespace

double chance_within_limits(double sigma_position_m, double sigma_heading_rad) {
  // Two equal axes: the distance follows Rayleigh's distribution.
  const double axis = std::max(1e-4, sigma_position_m / std::sqrt(2.0));
  const double position = 1.0 - std::exp(-0.5 * std::pow(kRightM / axis, 2));
  const double heading = std::erf(kRightRad / (std::sqrt(2.0) * std::max(1e-5, sigma_heading_rad)));
  return position * heading;
}

std::array<double, kConfidenceFeatures> confidence_features(const LocalizerEvidence& e) {
  return {1.0,
          std::log1p(std::max(0, e.inliers)),
          std::clamp(e.matched_share, 0.0, 1.0),
          std::clamp(e.depth_share, 0.0, 1.0),
          std::clamp(e.scan_share, 0.0, 1.0),
          std::log1p(std::clamp<double>(e.agreeing_frames, 0.0, kMostFrames)),
          std::log1p(std::clamp(e.recognitions, 0.0, kMostRecognitions)),
          std::clamp(e.rival_share, 0.0, 1.0),
          std::clamp(e.shape_margin, -0.3, 0.3),
          std::log1p(std::clamp(e.scan_points, 0, 400) / 40.0),
          std::clamp(e.surface_share, 0.0, 1.0),
          telling_points(e),
          joint_agreement(e)};
}

double confidence_of(const LocalizerEvidence& e) {
  const auto x = confidence_features(e);
  const double sum = std::inner_product(x.begin(), x.end(), kWeights.begin(), 0.0);
  return chance_within_limits(e.sigma_position_m, e.sigma_heading_rad) / (1.0 + std::exp(-sum));
}

}  // namespace rovigo::slam
