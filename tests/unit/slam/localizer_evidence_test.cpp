#include "slam/localizer_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rovigo::slam {
namespace {

LocalizerEvidence convincing() {
  LocalizerEvidence e;
  e.inliers = 150;
  e.matched_share = 0.6;
  e.depth_share = 0.97;
  e.scan_share = 0.97;
  e.agreeing_frames = 15;
  e.recognitions = 3.0;
  e.scan_points = 200;
  e.surface_share = 0.97;
  e.shape_margin = 0.15;
  e.sigma_position_m = 0.01;
  e.sigma_heading_rad = 0.005;
  return e;
}

TEST(ConfidenceOf, EverythingInFavourIsNearlyCertain) {
  EXPECT_GT(confidence_of(convincing()), kOkConfidence);
}

TEST(ConfidenceOf, NothingInFavourIsNoConfidence) {
  LocalizerEvidence e;
  e.depth_share = e.scan_share = 0.0;
  EXPECT_LT(confidence_of(e), 0.05);
}

TEST(ConfidenceOf, ALookAlikeWithHalfTheVotesIsNotOk) {
  LocalizerEvidence e = convincing();
  e.rival_share = 0.5;
  e.agreeing_frames = 3;
  e.recognitions = 0.8;
  e.inliers = 30;
  EXPECT_LT(confidence_of(e), kOkConfidence);
}

TEST(ConfidenceOf, AnotherPlaceOfTheSameShapeIsNotOk) {
  LocalizerEvidence e = convincing();
  e.shape_margin = 0.0;
  e.recognitions = 1.0;
  e.inliers = 20;
  EXPECT_LT(confidence_of(e), kOkConfidence);
}

TEST(ConfidenceOf, ASmallMarginSaysMoreTheMorePointsItComesFrom) {
  const auto odds = [](double margin, double scan_share, int points) {
    LocalizerEvidence e = convincing();
    e.shape_margin = margin;
    e.scan_share = scan_share;
    e.scan_points = points;
    e.recognitions = e.inliers = 0;
    const double p = confidence_of(e);
    return std::log(p / (1.0 - p));
  };
  const double gain = odds(0.06, 1.0, 160) - odds(0.06, 1.0, 50);
  EXPECT_GT(gain, odds(0.0, 1.0, 160) - odds(0.0, 1.0, 50) + 0.5);
  // Points that fit neither place speak for none.
  EXPECT_NEAR(odds(0.06, 0.9, 160) - odds(0.06, 0.9, 50), odds(0.0, 0.9, 160) - odds(0.0, 0.9, 50),
              0.1);
}

TEST(ConfidenceOf, FeaturesAndShapeTogetherSayMoreThanTheirSum) {
  const auto odds = [](int inliers, double margin) {
    LocalizerEvidence e = convincing();
    e.agreeing_frames = 2;
    e.recognitions = 0.5;
    e.inliers = inliers;
    e.shape_margin = margin;
    const double p = confidence_of(e);
    return std::log(p / (1.0 - p));
  };
  const double features = odds(20, 0.0) - odds(0, 0.0), shape = odds(0, 0.03) - odds(0, 0.0);
  EXPECT_GT(odds(20, 0.03), odds(0, 0.0) + features + shape + 1.0);
}

TEST(ConfidenceOf, IsAChanceForAnyEvidence) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(-1.0, 2.0);
  for (int i = 0; i < 2000; ++i) {
    LocalizerEvidence e;
    e.inliers = static_cast<int>(1000 * u(random));
    e.matched_share = u(random);
    e.depth_share = u(random);
    e.scan_share = u(random);
    e.agreeing_frames = static_cast<int>(100 * u(random));
    e.recognitions = 10 * u(random);
    e.rival_share = u(random);
    e.surface_share = u(random);
    e.shape_margin = u(random);
    e.scan_points = static_cast<int>(500 * u(random));
    e.sigma_position_m = std::abs(u(random));
    e.sigma_heading_rad = std::abs(u(random));
    const double p = confidence_of(e);
    EXPECT_GE(p, 0.0);
    EXPECT_LE(p, 1.0);
  }
}

TEST(ConfidenceOf, FallsAsDeadReckoningSpreads) {
  LocalizerEvidence e = convincing();
  double last = 1.0;
  for (const double sigma : {0.02, 0.1, 0.2, 0.4, 1.0}) {
    e.sigma_position_m = sigma;
    EXPECT_LT(confidence_of(e), last + 1e-12) << sigma;
    last = confidence_of(e);
  }
  EXPECT_LT(last, 0.1);
}

TEST(ChanceWithinLimits, AgreesWithRandomDraws) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (const auto& [sigma_m, sigma_rad] : {std::pair(0.1, 0.05), {0.3, 0.1}, {0.2, 0.3}}) {
    int within = 0;
    constexpr int kDraws = 40000;
    for (int i = 0; i < kDraws; ++i) {
      const double axis = sigma_m / std::sqrt(2.0);
      const double x = axis * normal(random), y = axis * normal(random);
      const double yaw = sigma_rad * normal(random);
      within += std::hypot(x, y) <= 0.20 && std::abs(yaw) <= 10.0 * 3.14159265358979 / 180.0;
    }
    EXPECT_NEAR(chance_within_limits(sigma_m, sigma_rad), static_cast<double>(within) / kDraws,
                0.01);
  }
}

}  // namespace
}  // namespace rovigo::slam
