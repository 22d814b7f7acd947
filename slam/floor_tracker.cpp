#include "slam/floor_tracker.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace rovigo::slam {

namespace {

constexpr double kFarthestM = 3.0;      // beyond it too few rays reach the floor
constexpr double kPointFloorM = 0.003;  // no return's height is trusted better
constexpr double kBiweight = 4.685;     // Tukey's constant
constexpr int kIterations = 4;
constexpr double kTogether = 6.0;  // neighbouring returns err together: so many count as one
constexpr double kMostTiltRad = 0.08, kMostHeightM = 0.08;  // off by more, it is not this mount
// The feet of walls are no floor: they stand in a narrow range and spread in height.
constexpr double kLeastRangeSpreadM = 0.1;
constexpr double kLeastFlatShare = 0.5;  // of the returns that might be floor, on the plane

struct FloorPoint {
  Eigen::Vector3d row;  ///< 1, x, y
  double z = 0.0, sigma = 0.0;
};

/// Returns within what prior and noise allow for the floor.
std::vector<FloorPoint> floor_points(const DepthScan& scan, const Eigen::Matrix3d& covariance) {
  std::vector<FloorPoint> out;
  for (std::size_t i = 0; i < static_cast<std::size_t>(scan.fine_from); ++i) {  // plenty
    const ScanRay& r = scan.rays[i];
    if (r.slope > -0.05f || r.range_m > kFarthestM) continue;
    FloorPoint p;
    p.row = {1.0, scan.camera.x() + static_cast<double>(r.range_m * r.along_x),
             scan.camera.y() + static_cast<double>(r.range_m * r.along_y)};
    p.z = static_cast<double>(scan.camera.z() + r.slope * r.range_m);
    p.sigma = std::max(kPointFloorM, static_cast<double>(-r.slope * r.sigma_m));
    const double gate = 3.0 * std::sqrt(p.row.dot(covariance * p.row) + p.sigma * p.sigma);
    if (std::abs(p.z) < gate) out.push_back(p);
  }
  return out;
}

double range_spread(const std::vector<FloorPoint>& points) {
  double sum = 0.0, squares = 0.0;
  for (const FloorPoint& p : points) {
    const double range = p.row.tail<2>().norm();
    sum += range;
    squares += range * range;
  }
  const auto n = static_cast<double>(points.size());
  return std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)));
}

double flat_share(const std::vector<FloorPoint>& points, const Eigen::Vector3d& plane) {
  const auto flat = std::count_if(points.begin(), points.end(), [&](const FloorPoint& p) {
    return std::abs(p.z - p.row.dot(plane)) < kBiweight * p.sigma;
  });
  return static_cast<double>(flat) / static_cast<double>(points.size());
}

}  // namespace

FloorTracker::FloorTracker(const FloorTrackerConfig& config) : config_(config) {
  const double h = config.mount_height_sigma_m, t = config.mount_tilt_sigma_rad;
  covariance_.diagonal() << h * h, t * t, t * t;
  plane_.sigma_height_m = h;
  plane_.sigma_tilt_rad = t;
}

void FloorTracker::update(const DepthScan& scan) {
  const auto points = floor_points(scan, covariance_);
  if (static_cast<int>(points.size()) < config_.min_points) return;
  if (range_spread(points) < kLeastRangeSpreadM) return;
  const double wh = config_.height_walk_m, wt = config_.tilt_walk_rad;
  Eigen::Matrix3d prior = covariance_;
  prior.diagonal() += Eigen::Vector3d(wh * wh, wt * wt, wt * wt);
  // What is left to correct, relative to the plane that the scan was made with.
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = prior.inverse();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    // The gate narrows: first everything the prior allows, then what the fit calls floor.
    const double widen = iteration == 0 ? 4.0 : iteration == 1 ? 2.0 : 1.0;
    Eigen::Matrix3d h = prior.inverse();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const FloorPoint& p : points) {
      const double residual = p.z - p.row.dot(step);
      const double u = residual / (widen * kBiweight * p.sigma);
      if (std::abs(u) >= 1.0) continue;
      const double w = (1.0 - u * u) * (1.0 - u * u) / (p.sigma * p.sigma * kTogether);
      h += w * p.row * p.row.transpose();
      b += w * p.z * p.row;
    }
    step = h.ldlt().solve(b);
    information = h;
  }
  if (flat_share(points, step) < kLeastFlatShare) return;
  const FloorPlane next{
      plane_.height_m + step[0], plane_.slope_x + step[1], plane_.slope_y + step[2], 0, 0,
      plane_.looks + 1};
  const double tilt = std::hypot(next.slope_x, next.slope_y);
  if (!(tilt < kMostTiltRad) || !(std::abs(next.height_m) < kMostHeightM)) return;
  plane_ = next;
  covariance_ = information.inverse();
  plane_.sigma_height_m = std::sqrt(covariance_(0, 0));
  plane_.sigma_tilt_rad = std::sqrt(std::max(covariance_(1, 1), covariance_(2, 2)));
}

Se3 FloorTracker::corrected(const Se3& nominal) const {
  // Turns the plane's normal onto the vertical, about the point of the plane below the origin.
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-plane_.slope_x, -plane_.slope_y, 1.0).normalized();
  const Eigen::Vector3d axis = normal.cross(Eigen::Vector3d::UnitZ());
  const double sine = axis.norm();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (sine > 1e-12) turn = so3_exp(axis / sine * std::asin(std::min(1.0, sine)));
  Se3 out;
  out.rotation = turn * nominal.rotation;
  out.translation = turn * (nominal.translation - Eigen::Vector3d(0, 0, plane_.height_m));
  return out;
}

}  // namespace rovigo::slam
