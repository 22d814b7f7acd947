#include "slam/depth_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace rovigo::slam {
namespace {

cv::Mat noisy_wall(int rows, int cols, double depth_mm, double sigma_mm, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(depth_mm, sigma_mm);
  cv::Mat out(rows, cols, CV_16UC1);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      out.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(noise(random)));
    }
  }
  return out;
}

double spread(const cv::Mat& depth, double truth) {
  double sum = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      sum += std::pow(depth.at<std::uint16_t>(v, u) - truth, 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(depth.total()));
}

TEST(DecimateDepth, EachPixelIsTheMedianOfItsBlocksReturns) {
  std::mt19937_64 random(3);
  cv::Mat depth(37, 41, CV_16UC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      depth.at<std::uint16_t>(v, u) =
          static_cast<std::uint16_t>(random() % 3 == 0 ? 0 : random() % 5000 + 1);
    }
  }
  for (const int factor : {2, 3, 4}) {
    const cv::Mat out = decimate_depth(depth, factor);
    ASSERT_EQ(out.size(), cv::Size(41 / factor, 37 / factor));
    for (int v = 0; v < out.rows; ++v) {
      for (int u = 0; u < out.cols; ++u) {
        std::vector<int> block;
        for (int i = 0; i < factor * factor; ++i) {
          const int d = depth.at<std::uint16_t>(v * factor + i / factor, u * factor + i % factor);
          if (d > 0) block.push_back(d);
        }
        std::sort(block.begin(), block.end());
        const bool enough = 2 * static_cast<int>(block.size()) >= factor * factor;
        EXPECT_EQ(out.at<std::uint16_t>(v, u), enough ? block[block.size() / 2] : 0);
      }
    }
  }
}

TEST(SmoothDepth, NoiseShrinksAndEdgesAndHolesStay) {
  cv::Mat depth = noisy_wall(60, 80, 2000, 6, 1);
  noisy_wall(60, 40, 3000, 6, 2).copyTo(depth.colRange(40, 80));
  depth.row(30).setTo(0);
  cv::Mat smooth = depth.clone();
  smooth_depth(smooth, {});
  EXPECT_LT(spread(smooth.rowRange(0, 30).colRange(0, 40), 2000), 3.0);
  EXPECT_LT(spread(smooth.rowRange(0, 30).colRange(40, 80), 3000), 3.0);
  for (int u = 0; u < 80; ++u) EXPECT_EQ(smooth.at<std::uint16_t>(30, u), 0);
}

TEST(FillDepthHoles, OnlyNarrowGapsWithinOneSurfaceAreBridged) {
  cv::Mat row(1, 16, CV_16UC1, cv::Scalar(0));
  const auto set = [&](int u, int mm) { row.at<std::uint16_t>(0, u) = std::uint16_t(mm); };
  set(1, 1000);
  set(4, 1006);   // two missing: bridged
  set(6, 2000);   // an edge: left open
  set(12, 2000);  // five missing: too wide
  fill_depth_holes(row, 3, 0.02);
  const std::vector<int> expected = {0, 1000, 1002, 1004, 1006, 0, 2000, 0,
                                     0, 0,    0,    0,    2000, 0, 0,    0};
  for (int u = 0; u < 16; ++u) {
    EXPECT_EQ(row.at<std::uint16_t>(0, u), expected[static_cast<std::size_t>(u)]) << u;
  }
}

TEST(TemporalDepthFilter, ARestingViewIsAveragedAndAChangeIsTakenAtOnce) {
  TemporalDepthFilter filter({});
  cv::Mat depth;
  for (std::uint64_t i = 0; i < 20; ++i) {
    depth = noisy_wall(30, 40, 2000, 6, i);
    filter.apply(depth);
  }
  EXPECT_LT(spread(depth, 2000), 4.0);
  depth = noisy_wall(30, 40, 1500, 0, 1);
  filter.apply(depth);
  EXPECT_EQ(spread(depth, 1500), 0.0);
}

TEST(TemporalDepthFilter, AMissingReturnIsHeldForAShortWhileOnly) {
  TemporalDepthFilter filter({.hold_frames = 2});
  cv::Mat wall(2, 2, CV_16UC1, cv::Scalar(1000));
  filter.apply(wall);
  for (int i = 0; i < 3; ++i) {
    cv::Mat nothing(2, 2, CV_16UC1, cv::Scalar(0));
    filter.apply(nothing);
    EXPECT_EQ(nothing.at<std::uint16_t>(0, 0), i < 2 ? 1000 : 0);
  }
}

TEST(DepthFilter, SwitchedOffItHandsOutTheSameImage) {
  DepthFilter filter({});
  const cv::Mat depth(4, 4, CV_16UC1, cv::Scalar(1234));
  EXPECT_EQ(filter.apply(depth, true).data, depth.data);
}

TEST(DepthFilter, TheInputIsNeverWrittenTo) {
  DepthFilter filter({.depth_decimation = 2,
                      .depth_spatial_filter = true,
                      .depth_temporal_filter = true,
                      .depth_hole_filling_px = 4});
  const cv::Mat depth = noisy_wall(20, 20, 2000, 10, 1);
  const cv::Mat before = depth.clone();
  const cv::Mat out = filter.apply(depth, true);
  EXPECT_EQ(out.size(), cv::Size(10, 10));
  EXPECT_EQ(cv::countNonZero(depth != before), 0);
}

}  // namespace
}  // namespace rovigo::slam
