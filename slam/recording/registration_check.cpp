#include "slam/recording/registration_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/recording/images.h"

namespace rovigo::slam {
namespace {

constexpr long kFewestEdges = 3000;
constexpr int kFewestFrames = 3;

/// Half the size, so that noise and a pixel or two of raggedness do not matter.
cv::Mat color_edges(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::Mat half;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  cv::resize(grey, half, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::Mat across;
  cv::Mat down;
  cv::Sobel(half, across, CV_32F, 1, 0);
  cv::Sobel(half, down, CV_32F, 0, 1);
  cv::Mat strength;
  cv::magnitude(across, down, strength);
  constexpr double kStrong = 80.0;  // a poster's edges shall count no more than a wall's
  return cv::min(strength, kStrong);
}

/// Two valid depths eight pixels apart with the middle in between: an occluding edge, whose own
/// pixels often have no return.
bool is_jump(std::uint16_t a, std::uint16_t b, double units_m) {
  if (a == 0 || b == 0) return false;
  const double nearer_m = std::min(a, b) * units_m;
  return std::abs(a - b) * units_m > std::max(0.15 * nearer_m, 0.10);
}

std::vector<cv::Point> depth_edges(const cv::Mat& depth, double units_m) {
  constexpr int kStep = 4;
  std::vector<cv::Point> edges;
  for (int v = kStep; v + kStep < depth.rows; v += 2) {
    for (int u = kStep; u + kStep < depth.cols; u += 2) {
      const auto at = [&](int row, int column) { return depth.at<std::uint16_t>(row, column); };
      if (is_jump(at(v, u - kStep), at(v, u + kStep), units_m) ||
          is_jump(at(v - kStep, u), at(v + kStep, u), units_m)) {
        edges.emplace_back(u / 2, v / 2);
      }
    }
  }
  return edges;
}

}  // namespace

RegistrationCheck::RegistrationCheck() : met_(std::size_t{kSide} * kSide, 0.0) {}

void RegistrationCheck::add(const mrpt::obs::CObservation3DRangeScan& scan) {
  const cv::Mat depth = depth_view(scan);
  const cv::Mat color = color_view(scan);
  if (depth.size() != color.size() || depth.cols < 8 * kReach || depth.rows < 8 * kReach) return;
  const cv::Mat strength = color_edges(color);
  ++frames_;
  for (const cv::Point& edge : depth_edges(depth, scan.rangeUnits)) {
    const bool is_inside = edge.x >= kReach && edge.y >= kReach &&
                           edge.x + kReach < strength.cols && edge.y + kReach < strength.rows;
    if (!is_inside) continue;
    ++edges_;
    for (int dy = -kReach; dy <= kReach; ++dy) {
      const float* const row = strength.ptr<float>(edge.y + dy) + edge.x - kReach;
      double* const met = met_.data() + static_cast<std::ptrdiff_t>(dy + kReach) * kSide;
      for (int i = 0; i < kSide; ++i) met[i] += row[i];
    }
  }
}

std::optional<cv::Point2d> RegistrationCheck::shift_px() const {
  if (edges_ < kFewestEdges || frames_ < kFewestFrames) return std::nullopt;
  const double mean =
      std::accumulate(met_.begin(), met_.end(), 0.0) / static_cast<double>(met_.size());
  const auto at = [this](int dx, int dy) {
    return met_[static_cast<std::size_t>((dy + kReach) * kSide + dx + kReach)];
  };
  double in_place = 0.0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) in_place = std::max(in_place, at(dx, dy));
  }
  const auto best = static_cast<int>(std::max_element(met_.begin(), met_.end()) - met_.begin());
  const int dx = best % kSide - kReach;
  const int dy = best / kSide - kReach;
  constexpr double kShift_px = 6.0;
  constexpr double kAboveMean = 0.25;  // a peak, not a slope of the scene
  constexpr double kAboveZero = 1.6;
  const double peak = at(dx, dy);
  const bool is_at_the_border = std::abs(dx) == kReach || std::abs(dy) == kReach;
  const bool is_clear =
      peak - mean > kAboveMean * mean && peak - mean > kAboveZero * std::max(in_place - mean, 0.0);
  // The top of the peak is flat, because depth edges are found a few pixels wide: its middle.
  constexpr int kWidth = 3;
  constexpr double kTop = 0.85;
  cv::Point2d weighted(0.0, 0.0);
  double weights = 0.0;
  for (int y = std::max(dy - kWidth, -kReach); y <= std::min(dy + kWidth, kReach); ++y) {
    for (int x = std::max(dx - kWidth, -kReach); x <= std::min(dx + kWidth, kReach); ++x) {
      const double weight = std::max(at(x, y) - mean - kTop * (peak - mean), 0.0);
      weighted += weight * cv::Point2d(x, y);
      weights += weight;
    }
  }
  const cv::Point2d shift = weighted * (2.0 / std::max(weights, 1e-9));
  if (is_at_the_border || !is_clear || std::hypot(shift.x, shift.y) < kShift_px) return {};
  return shift;
}

}  // namespace rovigo::slam
