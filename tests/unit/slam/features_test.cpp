#include "slam/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/support/pinhole.h"

namespace rovigo::slam {
namespace {

constexpr int kWidth = 640, kHeight = 480;

/// Boxes of many sizes and shades.
cv::Mat boxes(unsigned seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(most));
  };
  cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(128));
  for (int i = 0; i < 250; ++i) {
    const cv::Rect box(draw(kWidth), draw(kHeight), 8 + draw(60), 8 + draw(60));
    cv::rectangle(image, box, cv::Scalar(draw(256)), cv::FILLED);
  }
  cv::GaussianBlur(image, image, {3, 3}, 0.0);
  return image;
}

cv::Mat flat_depth(int millimetres) { return {kHeight, kWidth, CV_16UC1, cv::Scalar(millimetres)}; }

FeatureSet features_of(const cv::Mat& gray, const cv::Mat& depth) {
  CameraFrame frame;
  frame.gray = gray;
  frame.depth = depth;
  const FeatureConfig config{.features_per_frame = 4000};
  return extract_features(frame, CameraModel(test::pinhole()), config, DepthConfig{});
}

/// Mean of (pixel + mirrored pixel) less what it should be, over the corners of a level that both
/// images show.
double mirror_error_px(const FeatureSet& plain, const FeatureSet& mirrored, int octave) {
  double sum = 0.0;
  int count = 0;
  for (const Feature& a : plain.features()) {
    if (a.octave != octave) continue;
    for (const Feature& b : mirrored.features()) {
      const double dx = kWidth - 1 - b.pixel.x() - a.pixel.x(), dy = b.pixel.y() - a.pixel.y();
      if (b.octave != octave || std::hypot(dx, dy) > 3.0) continue;
      sum += dx;
      ++count;
    }
  }
  EXPECT_GT(count, 20) << "octave " << octave;
  return sum / std::max(1, count);
}

TEST(Features, CornersOfEveryLevelLieWhereTheirMirrorImagesSay) {
  const cv::Mat gray = boxes(3);
  cv::Mat mirrored;
  cv::flip(gray, mirrored, 1);
  const FeatureSet plain = features_of(gray, flat_depth(2000));
  const FeatureSet other = features_of(mirrored, flat_depth(2000));
  for (int octave = 0; octave < FeatureConfig{}.pyramid_levels; ++octave) {
    EXPECT_NEAR(mirror_error_px(plain, other, octave), 0.0, 0.12) << "octave " << octave;
  }
}

TEST(Features, CornersWhereANearerSurfaceEndsAreLeftOut) {
  constexpr int kEdge = 300;  // a post covers what lies left of it
  cv::Mat depth = flat_depth(4000);
  depth.colRange(0, kEdge) = cv::Scalar(1500);
  cv::Mat gray = boxes(4);
  gray.colRange(0, kEdge) = cv::Scalar(60);
  const auto near_edge = [&](const FeatureSet& set) {
    return std::count_if(set.features().begin(), set.features().end(), [&](const Feature& f) {
      return f.pixel.x() >= kEdge && f.pixel.x() < kEdge + 4 && f.octave < 3;
    });
  };
  EXPECT_GT(near_edge(features_of(gray, flat_depth(4000))), 10) << "one picture on one wall";
  EXPECT_EQ(near_edge(features_of(gray, depth)), 0) << "an outline before a wall";
}

}  // namespace
}  // namespace rovigo::slam
