#include "slam/depth_sample.h"

#include <algorithm>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr int kStep = 2;                            // of a keyframe's raster: every fourth point
constexpr double kGateM = 0.10, kGateShare = 0.03;  // errors of pose and depth
constexpr double kClosestM = 0.3;

double raster_pixel(int index, int count, int size) { return (index + 0.5) * size / count - 0.5; }

enum class Seen { kNothing, kThere, kThrough, kHidden };

/// Around the raster cell too: at an edge the neighbour's depth is as right.
Seen look_at(const DepthSample& view, int column, int row, double expected_m) {
  const double gate = kGateM + kGateShare * expected_m;
  bool nearer = false, farther = false;
  for (int r = std::max(0, row - 1); r <= std::min(DepthSample::kRows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(DepthSample::kCols - 1, column + 1); ++c) {
      const double z = view.meters[static_cast<std::size_t>(r * DepthSample::kCols + c)];
      if (z <= 0.0) continue;
      if (std::abs(z - expected_m) <= gate) return Seen::kThere;
      (z < expected_m ? nearer : farther) = true;
    }
  }
  if (nearer) return Seen::kHidden;
  return farther ? Seen::kThrough : Seen::kNothing;
}

}  // namespace

DepthSample sample_depth(const cv::Mat& depth, double unit_m) {
  DepthSample out;
  if (depth.empty()) return out;
  out.meters.reserve(DepthSample::kCols * DepthSample::kRows);
  for (int r = 0; r < DepthSample::kRows; ++r) {
    const int v = static_cast<int>((r + 0.5) * depth.rows / DepthSample::kRows);
    for (int c = 0; c < DepthSample::kCols; ++c) {
      const int u = static_cast<int>((c + 0.5) * depth.cols / DepthSample::kCols);
      out.meters.push_back(static_cast<float>(unit_m * depth.at<std::uint16_t>(v, u)));
    }
  }
  return out;
}

std::vector<Eigen::Vector3f> lift(const DepthSample& sample, const CameraModel& camera) {
  std::vector<Eigen::Vector3f> points;
  if (sample.meters.empty()) return points;
  for (int r = 0; r < DepthSample::kRows; r += kStep) {
    for (int c = 0; c < DepthSample::kCols; c += kStep) {
      const double z = sample.meters[static_cast<std::size_t>(r * DepthSample::kCols + c)];
      if (z <= 0.0) continue;
      const Eigen::Vector2d raw(raster_pixel(c, DepthSample::kCols, camera.width()),
                                raster_pixel(r, DepthSample::kRows, camera.height()));
      points.push_back(camera.unproject(camera.undistort(raw), z).cast<float>());
    }
  }
  return points;
}

DepthAgreement compare(const std::vector<Eigen::Vector3f>& points_there, const Se3& here_from_there,
                       const DepthSample& here, const CameraModel& camera) {
  DepthAgreement out;
  if (here.meters.empty()) return out;
  for (const Eigen::Vector3f& p : points_there) {
    const Eigen::Vector3d q = here_from_there * p.cast<double>();
    if (q.z() < kClosestM) continue;
    const Eigen::Vector2d ideal = camera.project(q);
    if (!camera.in_image(ideal, 0.0)) continue;
    const Eigen::Vector2d raw = camera.distort(ideal);
    if (!camera.in_image(raw, 0.0)) continue;
    const int column = static_cast<int>(raw.x() * DepthSample::kCols / camera.width());
    const int row = static_cast<int>(raw.y() * DepthSample::kRows / camera.height());
    switch (look_at(here, column, row, q.z())) {
      case Seen::kThere:
        ++out.at_depth;
        break;
      case Seen::kThrough:
        ++out.seen_through;
        break;
      case Seen::kHidden:
        ++out.hidden;
        break;
      case Seen::kNothing:
        break;
    }
  }
  return out;
}

}  // namespace rovigo::slam
