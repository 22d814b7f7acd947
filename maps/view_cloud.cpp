#include "maps/view_cloud.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>

#include "maps/error.h"
#include "maps/stored_image.h"

namespace rovigo::maps {
namespace {

/// Viewing rays (z = 1) of every `stride`-th pixel of a width x height image.
std::vector<cv::Point2f> rays(const mrpt::img::TCamera& camera, int width, int height, int stride) {
  const double sx = camera.ncols > 0 ? static_cast<double>(width) / camera.ncols : 1.0;
  const double sy = camera.nrows > 0 ? static_cast<double>(height) / camera.nrows : 1.0;
  const auto& k = camera.intrinsicParams;
  const cv::Matx33d intrinsics(sx * k(0, 0), 0.0, sx * k(0, 2), 0.0, sy * k(1, 1), sy * k(1, 2),
                               0.0, 0.0, 1.0);
  std::vector<cv::Point2f> pixels;
  for (int v = 0; v < height; v += stride) {
    for (int u = 0; u < width; u += stride) {
      pixels.emplace_back(static_cast<float>(u), static_cast<float>(v));
    }
  }
  std::vector<cv::Point2f> result;
  if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt) {
    // MRPT keeps k1 .. k4 in places 0, 1, 4 and 5.
    const cv::Vec4d d(camera.dist[0], camera.dist[1], camera.dist[4], camera.dist[5]);
    cv::fisheye::undistortPoints(pixels, result, intrinsics, d);
  } else {
    std::vector<double> d;
    if (camera.distortion == mrpt::img::DistortionModel::plumb_bob) {
      d.assign(camera.dist.begin(), camera.dist.end());
    }
    cv::undistortPoints(pixels, result, intrinsics, d);
  }
  return result;
}

cv::Vec3b color_at(const cv::Mat& color, int u, int v, const cv::Mat& depth) {
  if (color.empty()) return {160, 160, 160};
  const int x = static_cast<int>(static_cast<std::int64_t>(u) * color.cols / depth.cols);
  const int y = static_cast<int>(static_cast<std::int64_t>(v) * color.rows / depth.rows);
  return color.at<cv::Vec3b>(y, x);
}

}  // namespace

ViewPoints view_points(const StoredKeyframe& keyframe, const MapMetadata& metadata, int stride) {
  const auto map_from_camera = keyframe.map_from_base + metadata.base_from_camera;
  ViewPoints view{{map_from_camera.x(), map_from_camera.y(), map_from_camera.z()}, {}};
  if (keyframe.depth_png.empty()) return view;
  const auto& k = metadata.camera.intrinsicParams;
  if (!(k(0, 0) > 0.0) || !(k(1, 1) > 0.0)) {
    throw InputError("the map's camera has no focal length, so its depth images give no points");
  }
  const cv::Mat depth = decode_depth(keyframe);
  const cv::Mat color = decode_color(keyframe);
  const std::vector<cv::Point2f> ray = rays(metadata.camera, depth.cols, depth.rows, stride);
  std::size_t i = 0;
  for (int v = 0; v < depth.rows; v += stride) {
    for (int u = 0; u < depth.cols; u += stride, ++i) {
      const std::uint16_t millimeters = depth.at<std::uint16_t>(v, u);
      if (millimeters == 0) continue;
      const double z = 0.001 * millimeters;
      double x_map = 0.0;
      double y_map = 0.0;
      double z_map = 0.0;
      map_from_camera.composePoint(ray[i].x * z, ray[i].y * z, z, x_map, y_map, z_map);
      if (!std::isfinite(x_map + y_map + z_map)) continue;
      const cv::Vec3b bgr = color_at(color, u, v, depth);
      view.points.push_back({static_cast<float>(x_map), static_cast<float>(y_map),
                             static_cast<float>(z_map), bgr[2], bgr[1], bgr[0]});
    }
  }
  return view;
}

void VoxelFilter::add(const std::vector<ColoredPoint>& points) {
  constexpr double kHalfRange = 1 << 20;  // 21 bits for each axis
  const auto index = [&](double meters) {
    const double cell = std::floor(meters / voxel_m_) + kHalfRange;
    return static_cast<std::uint64_t>(std::clamp(cell, 0.0, 2.0 * kHalfRange - 1.0));
  };
  for (const ColoredPoint& p : points) {
    Sum& sum = cubes_[index(p.z) << 42 | index(p.y) << 21 | index(p.x)];
    sum.x += p.x;
    sum.y += p.y;
    sum.z += p.z;
    sum.r += p.r;
    sum.g += p.g;
    sum.b += p.b;
    ++sum.count;
  }
}

std::vector<ColoredPoint> VoxelFilter::points() const {
  std::vector<std::pair<std::uint64_t, const Sum*>> sorted;
  for (const auto& [key, sum] : cubes_) sorted.emplace_back(key, &sum);
  std::sort(sorted.begin(), sorted.end());
  std::vector<ColoredPoint> points;
  for (const auto& [key, sum] : sorted) {
    const auto n = static_cast<double>(sum->count);
    const auto mean = [&](std::uint64_t s) {
      return static_cast<std::uint8_t>((s + sum->count / 2) / sum->count);
    };
    points.push_back({static_cast<float>(sum->x / n), static_cast<float>(sum->y / n),
                      static_cast<float>(sum->z / n), mean(sum->r), mean(sum->g), mean(sum->b)});
  }
  return points;
}

}  // namespace rovigo::maps
