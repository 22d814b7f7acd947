#include "slam/grid_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "maps/distance_field.h"
#include "slam/planar_fit.h"

namespace rovigo::slam {

namespace {

constexpr double kGridSigmaM = 0.02;  // a wall's place within its 5 cm cell
constexpr double kCauchyScale = 2.0;  // in sigmas
constexpr double kInlierSigmas = 3.0;
constexpr int kIterations = 15;
constexpr int kPixelStep = 4;
constexpr double kUnseenShare = 0.8;
constexpr double kNearWallM = 0.12;  // two cells, and a pose as good as appearance gives it
// Neighbouring points share their errors (one wall, one cell row): count them as fewer.
constexpr double kIndependentShare = 0.1;

/// Distances from free cells to obstacles and from obstacles to free ground, in one signed field.
std::vector<float> signed_meters(const maps::OccupancyGrid& grid) {
  maps::OccupancyGrid inverted = grid;
  for (auto& cell : inverted.cells) {
    cell = maps::OccupancyGrid::is_occupied(cell) ? maps::OccupancyGrid::kFree
                                                  : maps::OccupancyGrid::kOccupied;
  }
  std::vector<float> out = maps::distance_to_occupied(grid).meters;
  const std::vector<float> inside = maps::distance_to_occupied(inverted).meters;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (maps::OccupancyGrid::is_occupied(grid.cells[i])) out[i] = -inside[i];
  }
  return out;
}

PlanarCost linearize(const SignedDistanceField& field, const std::vector<ScanPoint>& scan,
                     const TPose2D& pose, double surface_depth_m) {
  PlanarCost out;
  for (const ScanPoint& p : scan) {
    const TPoint2D map_point = maps::transform(pose, p.base_point);
    const auto sample = field.at(map_point);
    if (!sample.known) continue;
    ++out.points;
    const double variance = p.sigma_m * p.sigma_m + kGridSigmaM * kGridSigmaM;
    const double off_m = sample.meters + surface_depth_m;
    const double normalized = off_m / std::sqrt(variance);
    out.inliers += std::abs(normalized) < kInlierSigmas;
    const double ratio = normalized / kCauchyScale;
    const double weight = kIndependentShare / (variance * (1.0 + ratio * ratio));
    const Eigen::Vector2d arm(-(map_point.y - pose.y), map_point.x - pose.x);
    const Eigen::Vector3d jacobian(sample.gradient.x(), sample.gradient.y(),
                                   sample.gradient.dot(arm));
    out.information += weight * jacobian * jacobian.transpose();
    out.gradient += weight * off_m * jacobian;
  }
  return out;
}

}  // namespace

SignedDistanceField::SignedDistanceField(const maps::OccupancyGrid& grid)
    : geometry_(grid.geometry), meters_(signed_meters(grid)), known_(grid.cells.size()) {
  for (std::size_t i = 0; i < known_.size(); ++i) {
    known_[i] = !maps::OccupancyGrid::is_unknown(grid.cells[i]) && std::isfinite(meters_[i]);
  }
}

SignedDistanceField::Sample SignedDistanceField::at(const TPoint2D& point) const {
  const double u = (point.x - geometry_.origin.x) / geometry_.resolution_m - 0.5;
  const double v = (point.y - geometry_.origin.y) / geometry_.resolution_m - 0.5;
  Sample out;
  if (!(u >= 0.0 && v >= 0.0 && u < geometry_.width - 1 && v < geometry_.height - 1)) return out;
  const maps::Cell low{static_cast<int>(u), static_cast<int>(v)};
  const double fx = u - low.x, fy = v - low.y;
  double corner[2][2];
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const std::size_t index = geometry_.index_of({low.x + dx, low.y + dy});
      if (!known_[index]) return out;
      corner[dy][dx] = meters_[index];
    }
  }
  out.known = true;
  out.meters = (1 - fy) * ((1 - fx) * corner[0][0] + fx * corner[0][1]) +
               fy * ((1 - fx) * corner[1][0] + fx * corner[1][1]);
  out.gradient.x() =
      ((1 - fy) * (corner[0][1] - corner[0][0]) + fy * (corner[1][1] - corner[1][0])) /
      geometry_.resolution_m;
  out.gradient.y() =
      ((1 - fx) * (corner[1][0] - corner[0][0]) + fx * (corner[1][1] - corner[0][1])) /
      geometry_.resolution_m;
  return out;
}

SignedDistanceField::CellSample SignedDistanceField::cell_at(const TPoint2D& point) const {
  const maps::Cell cell = geometry_.cell_at(point);
  if (!geometry_.contains(cell)) return {false, std::numeric_limits<double>::infinity()};
  const std::size_t index = geometry_.index_of(cell);
  return {known_[index], std::max(0.0F, meters_[index])};
}

ScanAgreement scan_agreement(const SignedDistanceField& field, const std::vector<ScanPoint>& scan,
                             const TPose2D& map_from_base) {
  ScanAgreement out;
  out.points = static_cast<int>(scan.size());
  if (scan.empty()) return out;
  double sum = 0.0;
  for (const ScanPoint& p : scan) {
    const auto cell = field.cell_at(maps::transform(map_from_base, p.base_point));
    const bool near = cell.wall_m < kNearWallM + kInlierSigmas * p.sigma_m;
    sum += near ? 1.0 : cell.known ? 0.0 : kUnseenShare;
  }
  out.share = sum / static_cast<double>(scan.size());
  return out;
}

std::vector<ScanPoint> obstacle_points(const cv::Mat& depth, double unit_m,
                                       const CameraModel& camera, const Se3& base_from_camera,
                                       const SlamConfig& config) {
  std::vector<ScanPoint> scan;
  for (int u = 0; u < depth.cols; u += kPixelStep) {
    ScanPoint nearest;
    double nearest_m = config.grid.mapping_range_m;
    for (int v = 0; v < depth.rows; v += kPixelStep) {
      const double z = depth.at<std::uint16_t>(v, u) * unit_m;
      if (z < config.depth.min_depth_m || z >= nearest_m) continue;
      const Eigen::Vector3d p =
          base_from_camera * camera.unproject(camera.undistort(Eigen::Vector2d(u, v)), z);
      if (p.z() < config.grid.obstacle_min_height_m || p.z() > config.grid.obstacle_max_height_m) {
        continue;
      }
      nearest_m = z;
      nearest = {{p.x(), p.y()}, config.depth.sigma_at_1m_m * z * z};
    }
    if (nearest_m < config.grid.mapping_range_m) scan.push_back(nearest);
  }
  return scan;
}

GridMatch match_scan(const SignedDistanceField& field, const std::vector<ScanPoint>& scan,
                     const TPose2D& prior, const Eigen::Matrix3d& prior_covariance,
                     double surface_depth_m) {
  const PlanarFit fit = fit_planar(prior, prior_covariance, kIterations, [&](const TPose2D& pose) {
    return linearize(field, scan, pose, surface_depth_m);
  });
  GridMatch match;
  match.look = fit.look;
  match.points = fit.points;
  match.inlier_share = fit.inlier_share();
  return match;
}

}  // namespace rovigo::slam
