#include "slam/camera_frame.h"

#include <mrpt/core/Clock.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "maps/error.h"

namespace rovigo::slam {

namespace {

void check_size(const cv::Mat& image, const CameraModel& camera, const char* what) {
  if (image.cols == camera.width() && image.rows == camera.height()) return;
  throw maps::InputError(std::string("The ") + what + " image is " + std::to_string(image.cols) +
                         "x" + std::to_string(image.rows) +
                         " but the camera's calibration is for " + std::to_string(camera.width()) +
                         "x" + std::to_string(camera.height()) +
                         "; give the right one with --camera-info.");
}

cv::Mat to_gray(const cv::Mat& color) {
  if (color.channels() == 1) return color.clone();
  cv::Mat gray;
  cv::cvtColor(color, gray, color.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  return gray;
}

/// Ranges along the ray become depths along the optical axis.
void ranges_to_depths(cv::Mat& depth, const CameraModel& camera) {
  for (int v = 0; v < depth.rows; ++v) {
    auto* row = depth.ptr<std::uint16_t>(v);
    for (int u = 0; u < depth.cols; ++u) {
      const double ray = camera.unproject(camera.undistort({u, v}), 1.0).norm();
      row[u] = static_cast<std::uint16_t>(std::lround(row[u] / ray));
    }
  }
}

// An outline: inverse depth that rises by so many of its sigmas, and by so large a share.
constexpr double kEdgeSigmas = 10.0, kEdgeShare = 0.06;

}  // namespace

double CameraFrame::depth_at(const Eigen::Vector2d& raw_pixel, const DepthConfig& config) const {
  const int u = static_cast<int>(std::lround(raw_pixel.x()));
  const int v = static_cast<int>(std::lround(raw_pixel.y()));
  if (depth.empty() || u < 1 || v < 1 || u >= depth.cols - 1 || v >= depth.rows - 1) return 0.0;
  const double z = depth.at<std::uint16_t>(v, u) * depth_unit_m;
  // Near the end of the range only readings that err short come through: their mean would lie.
  const double farthest =
      config.max_depth_m - 3.0 * config.sigma_at_1m_m * config.max_depth_m * config.max_depth_m;
  if (z < config.min_depth_m || z > farthest) return 0.0;
  // Neighbours within the noise are averaged; any beyond it means an edge.
  const double gate = std::max(0.02, 5.0 * config.sigma_at_1m_m * z * z) + 0.01 * z;
  double sum = 0.0;
  int n = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    const auto* row = depth.ptr<std::uint16_t>(v + dv);
    for (int du = -1; du <= 1; ++du) {
      if (row[u + du] == 0) continue;
      const double zn = row[u + du] * depth_unit_m;
      if (std::abs(zn - z) > gate) return 0.0;
      sum += zn;
      ++n;
    }
  }
  return n >= 4 ? sum / n : 0.0;
}

bool CameraFrame::is_beside_nearer(const Eigen::Vector2d& raw_pixel, double radius_px,
                                   const DepthConfig& config) const {
  const int u = static_cast<int>(std::lround(raw_pixel.x()));
  const int v = static_cast<int>(std::lround(raw_pixel.y()));
  const auto inverse_at = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= depth.cols || row >= depth.rows) return 0.0;
    const double z = depth.at<std::uint16_t>(row, column) * depth_unit_m;
    return z > 0 ? 1.0 / z : 0.0;
  };
  const double here = depth.empty() ? 0.0 : inverse_at(u, v);
  if (here == 0.0) return false;
  // Along a plane inverse depth changes evenly, whatever its slant (and its noise is even, too).
  const double gate = std::max(kEdgeSigmas * config.sigma_at_1m_m, kEdgeShare * here);
  const int r = static_cast<int>(std::ceil(radius_px));
  for (const int step : {r, (r + 1) / 2}) {
    for (const auto& [du, dv] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
      const double one = inverse_at(u + step * du, v + step * dv);
      const double other = inverse_at(u - step * du, v - step * dv);
      if (one > 0 && other > 0 && one + other - 2.0 * here > gate) return true;
    }
  }
  return false;
}

double time_of(const mrpt::obs::CObservation& observation) {
  return mrpt::Clock::toDouble(observation.timestamp);
}

CameraFrame camera_frame_from(const mrpt::obs::CObservation3DRangeScan& scan,
                              const CameraModel& camera) {
  CameraFrame frame;
  frame.time_s = time_of(scan);
  if (scan.hasIntensityImage && !scan.intensityImage.isEmpty()) {
    frame.color = scan.intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
    check_size(frame.color, camera, "colour");
    frame.gray = to_gray(frame.color);
  }
  if (scan.hasRangeImage && scan.rangeImage.size() > 0) {
    const auto& ranges = scan.rangeImage;
    frame.depth.create(static_cast<int>(ranges.rows()), static_cast<int>(ranges.cols()), CV_16UC1);
    for (int v = 0; v < frame.depth.rows; ++v) {
      std::copy_n(&ranges(v, 0), frame.depth.cols, frame.depth.ptr<std::uint16_t>(v));
    }
    check_size(frame.depth, camera, "depth");
    frame.depth_unit_m = scan.rangeUnits;
    if (!scan.range_is_depth) ranges_to_depths(frame.depth, camera);
  }
  return frame;
}

}  // namespace rovigo::slam
