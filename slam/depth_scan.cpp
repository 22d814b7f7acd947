#include "slam/depth_scan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rovigo::slam {

namespace {

constexpr int kStride = 4;             // every fourth pixel in both directions
constexpr int kMinPixels = 2;          // fewer that agree on a range are noise
constexpr float kClearBeyondM = 2.0f;  // farther than obstacles are marked, space is still cleared
constexpr std::size_t kClearRank = 3;  // the farthest few rays of a direction may be stray

}  // namespace

DepthScanner::DepthScanner(const CameraModel& camera, const GridConfig& grid,
                           const DepthConfig& depth)
    : camera_(camera), grid_(grid), depth_(depth) {}

void DepthScanner::aim(const Se3& level_from_camera) {
  if (aimed_ && local(aimed_at_, level_from_camera).norm() < 1e-9) return;
  aimed_ = true;
  aimed_at_ = level_from_camera;
  rays_.clear();
  std::vector<float> azimuths;
  float low = 1e9f, high = -1e9f;
  // Azimuths are taken against the view's middle, so that they never wrap inside one view.
  const Eigen::Vector3d forward = level_from_camera.rotation.col(2);
  const double middle = std::atan2(forward.y(), forward.x());
  for (int v = 0; v < camera_.height(); v += kStride) {
    for (int u = 0; u < camera_.width(); u += kStride) {
      const Eigen::Vector3d d =
          level_from_camera.rotation * camera_.unproject(camera_.undistort({u, v}), 1.0);
      Ray ray;
      ray.across = static_cast<float>(d.head<2>().norm());
      ray.up = static_cast<float>(d.z());
      rays_.push_back(ray);
      azimuths.push_back(
          static_cast<float>(middle + maps::wrap_angle(std::atan2(d.y(), d.x()) - middle)));
      low = std::min(low, azimuths.back());
      high = std::max(high, azimuths.back());
    }
  }
  directions_ = camera_.width() / kStride;
  first_direction_rad_ = low;
  direction_step_rad_ = std::max(1e-4f, (high - low) / static_cast<float>(directions_));
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    rays_[i].direction =
        std::clamp(static_cast<int>((azimuths[i] - low) / direction_step_rad_), 0, directions_ - 1);
  }
}

DepthScan DepthScanner::scan(const cv::Mat& depth, double unit_m, const Se3& level_from_camera) {
  aim(level_from_camera);
  DepthScan out;
  out.origin = level_from_camera.translation.head<2>().cast<float>();
  out.first_direction_rad = first_direction_rad_ + 0.5f * direction_step_rad_;
  out.direction_step_rad = direction_step_rad_;
  const auto n = static_cast<std::size_t>(directions_);
  std::vector<std::vector<float>> obstacle(n), clear(n);
  const auto height = static_cast<float>(level_from_camera.translation.z());
  const auto lowest = static_cast<float>(grid_.obstacle_min_height_m);
  const auto highest = static_cast<float>(grid_.obstacle_max_height_m);
  const auto reach = static_cast<float>(grid_.mapping_range_m);
  std::size_t i = 0;
  for (int v = 0; v < depth.rows; v += kStride) {
    const auto* row = depth.ptr<std::uint16_t>(v);
    for (int u = 0; u < depth.cols; u += kStride, ++i) {
      const float z = static_cast<float>(row[u] * unit_m);
      if (z < static_cast<float>(depth_.min_depth_m)) continue;
      const Ray& ray = rays_[i];
      const float range = z * ray.across;
      const float z_height = height + z * ray.up;
      if (z_height > lowest && z_height < highest && range < reach) {
        obstacle[static_cast<std::size_t>(ray.direction)].push_back(range);
      }
      // A ray vouches for the ground it passes below the top of the rover's world, and not for
      // the last bit before what it hits.
      const float sigma = static_cast<float>(depth_.sigma_at_1m_m) * z * z;
      float free = std::min(range - 3.0f * sigma, reach + kClearBeyondM);
      if (z_height > highest) {
        free = std::min(free, range * (highest - height) / std::max(1e-3f, z_height - height));
      }
      if (free > 0) clear[static_cast<std::size_t>(ray.direction)].push_back(free);
    }
  }
  out.clear_m.resize(n, 0.0f);
  for (std::size_t d = 0; d < n; ++d) {
    cluster(static_cast<int>(d), obstacle[d], out);
    if (clear[d].size() < kClearRank) continue;
    std::nth_element(clear[d].begin(), clear[d].begin() + (kClearRank - 1), clear[d].end(),
                     std::greater<>());
    out.clear_m[d] = clear[d][kClearRank - 1];
  }
  return out;
}

void DepthScanner::cluster(int direction, std::vector<float>& ranges, DepthScan& scan) const {
  std::sort(ranges.begin(), ranges.end());
  std::size_t first = 0;
  const auto sigma_at = [&](float r) { return static_cast<float>(depth_.sigma_at_1m_m) * r * r; };
  for (std::size_t i = 1; i <= ranges.size(); ++i) {
    // One cluster spans what noise spreads an upright surface over; longer ones (table tops,
    // walls along the view) become a row of clusters.
    const float span = std::max(0.5f * static_cast<float>(grid_.grid_resolution_m),
                                4.0f * sigma_at(ranges[first]));
    if (i < ranges.size() && ranges[i] - ranges[first] < span) continue;
    const auto pixels = static_cast<int>(i - first);
    if (pixels >= kMinPixels) {
      const float mean = std::accumulate(ranges.begin() + static_cast<std::ptrdiff_t>(first),
                                         ranges.begin() + static_cast<std::ptrdiff_t>(i), 0.0f) /
                         static_cast<float>(pixels);
      scan.hits.push_back(
          {direction, mean, sigma_at(mean) / std::sqrt(static_cast<float>(pixels)), pixels});
    }
    first = i;
  }
}

}  // namespace rovigo::slam
