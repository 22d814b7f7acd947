#include "slam/floor_depth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rovigo::slam {

namespace {

constexpr double kFlatM = 0.025;  // a return this near to the plane may be the floor's
constexpr double kBelowM = 0.03, kBelowShare = 0.01;  // uneven, and the rover rocks
constexpr double kSigmasBelow = 2.0;                  // of what is not known of the plane
constexpr double kFarthestM = 3.0;
constexpr double kLeastFall = 0.05;  // of a ray, for the floor to be met before the walls
// Of a frame: what is read more evenly than this is right on average. Matt floors are at 0.002,
// mirroring ones at 0.03.
constexpr double kUneven = 0.008;
constexpr double kPlaneShare = 0.01;  // error of a depth taken from the plane: mount, unevenness
constexpr double kUpShare = 0.15;     // how far up the floor a pixel's surface is followed
constexpr int kRasterPx = 8;          // of the readings that roughness is measured by
constexpr int kAround = 3;            // readings on each side
constexpr std::size_t kEnough = 6;    // of them
constexpr std::size_t kEnoughSteps = 30;
constexpr double kSigmaPerMad = 1.4826;  // of a normal distribution

double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

FloorDepth::FloorDepth(const CameraFrame& frame, const CameraModel& camera,
                       const DepthConfig& config, const Se3& level_from_camera,
                       const FloorPlane& plane)
    : frame_(frame),
      camera_(camera),
      config_(config),
      level_from_camera_(level_from_camera),
      plane_(plane) {
  if (plane.looks == 0) return;
  read_floor();
  roughness_ = measure_roughness();
}

double FloorDepth::at(const Eigen::Vector2d& raw_pixel) const {
  const double measured = frame_.depth_at(raw_pixel, config_);
  if (!(measured > 0.0)) return measured;
  if (is_below(raw_pixel, measured)) return 0.0;
  if (roughness_ < kUneven) return measured;
  const double plane = plane_at(raw_pixel);
  if (plane == 0.0 || std::abs(height_m(measured, plane)) > kFlatM) return measured;
  if (!rises_as_floor(raw_pixel, plane)) return measured;
  const auto roughness = roughness_around(raw_pixel);
  if (!roughness) return measured;
  const double weight =
      *roughness * *roughness / (*roughness * *roughness + kPlaneShare * kPlaneShare);
  return measured + weight * (plane - measured);
}

/// Under the floor there is only what it mirrors. The image shows both there, one over the other:
/// a corner of the floor's own at the mirror image's depth would move too slowly for it.
bool FloorDepth::is_below(const Eigen::Vector2d& raw_pixel, double measured_m) const {
  const Eigen::Vector3d point =
      level_from_camera_ * camera_.unproject(camera_.undistort(raw_pixel), measured_m);
  const double tolerance_m = kBelowM + kSigmasBelow * plane_.sigma_height_m +
                             (kBelowShare + kSigmasBelow * plane_.sigma_tilt_rad) * measured_m;
  return point.z() < -tolerance_m;
}

/// Depth at which the pixel's ray meets the plane; 0 when it does not, or far away.
double FloorDepth::plane_at(const Eigen::Vector2d& raw_pixel) const {
  const Eigen::Vector3d ray =
      level_from_camera_.rotation * camera_.unproject(camera_.undistort(raw_pixel), 1.0);
  if (ray.z() > -kLeastFall) return 0.0;
  const double depth = -level_from_camera_.translation.z() / ray.z();
  return depth > 0.0 && depth < kFarthestM ? depth : 0.0;
}

/// Over the plane, by similar triangles: along the ray the camera's own height shrinks to 0.
double FloorDepth::height_m(double measured_m, double plane_m) const {
  return level_from_camera_.translation.z() * (1.0 - measured_m / plane_m);
}

/// What stands on the floor begins at its height, but its depth stays as rows go up, where the
/// floor's grows.
bool FloorDepth::rises_as_floor(const Eigen::Vector2d& raw_pixel, double plane_m) const {
  const double rows_below_horizon = level_from_camera_.translation.z() / plane_m * camera_.fy();
  const double up_px = kUpShare * rows_below_horizon;
  double measured_sum = 0.0, plane_sum = 0.0, n = 0.0;
  for (const double aside_px : {-up_px, 0.0, up_px}) {
    const Eigen::Vector2d there = raw_pixel + Eigen::Vector2d(aside_px, -up_px);
    const double measured = frame_.depth_at(there, config_), plane = plane_at(there);
    if (!(measured > 0.0) || plane == 0.0) continue;
    measured_sum += measured;
    plane_sum += plane;
    ++n;
  }
  const double growth = measured_sum - n * plane_m, of_floor = plane_sum - n * plane_m;
  return growth > 0.5 * of_floor && growth < 1.5 * of_floor;
}

/// Spread of the readings about each other, as a share of the depth (1 sigma): a rug lies higher
/// than the floor, but evenly.
std::optional<double> FloorDepth::roughness_around(const Eigen::Vector2d& raw_pixel) const {
  const int column = static_cast<int>(raw_pixel.x()) / kRasterPx;
  const int row = static_cast<int>(raw_pixel.y()) / kRasterPx;
  std::vector<float> near;
  for (int r = std::max(0, row - kAround); r <= std::min(rows_ - 1, row + kAround); ++r) {
    for (int c = std::max(0, column - kAround); c <= std::min(columns_ - 1, column + kAround);
         ++c) {
      const float ratio = ratios_[static_cast<std::size_t>(r * columns_ + c)];
      if (ratio > 0.0F) near.push_back(ratio);
    }
  }
  if (near.size() < kEnough) return std::nullopt;
  const auto middle = static_cast<float>(median(near));
  for (float& ratio : near) ratio = std::abs(ratio - middle);
  return kSigmaPerMad * median(near);
}

double FloorDepth::measure_roughness() const {
  std::vector<float> steps;
  for (int r = 0; r < rows_; ++r) {
    for (int c = kAround; c < columns_; ++c) {
      const auto here = static_cast<std::size_t>(r * columns_ + c);
      const float a = ratios_[here], b = ratios_[here - kAround];
      if (a > 0.0F && b > 0.0F) steps.push_back(std::abs(a - b));
    }
  }
  if (steps.size() < kEnoughSteps) return 0.0;
  return kSigmaPerMad * median(steps) / std::sqrt(2.0);  // both ends err
}

void FloorDepth::read_floor() {
  columns_ = frame_.depth.cols / kRasterPx;
  rows_ = frame_.depth.rows / kRasterPx;
  ratios_.assign(static_cast<std::size_t>(columns_ * rows_), 0.0F);
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      const int u = c * kRasterPx + kRasterPx / 2, v = r * kRasterPx + kRasterPx / 2;
      const double measured = frame_.depth.at<std::uint16_t>(v, u) * frame_.depth_unit_m;
      const double plane = measured > 0.0 ? plane_at({u, v}) : 0.0;
      if (plane == 0.0 || std::abs(height_m(measured, plane)) > kFlatM) continue;
      ratios_[static_cast<std::size_t>(r * columns_ + c)] = static_cast<float>(measured / plane);
    }
  }
}

}  // namespace rovigo::slam
