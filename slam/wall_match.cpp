#include "slam/wall_match.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "slam/planar_fit.h"

namespace rovigo::slam {

namespace {

constexpr int kColumnStep = 4, kRowStep = 4;
constexpr std::size_t kMinRows = 4;     // of a column that meet something
constexpr double kSystematicM = 0.004;  // what averaging over rows does not remove
constexpr int kNeighbours = 4;          // columns to either side that a line is fitted through
constexpr float kNeighbourM = 0.4f;
constexpr double kCorrespondM = 0.25;
constexpr double kCauchyScale = 2.0, kInlierSigmas = 3.0;
constexpr int kIterations = 10;
constexpr double kSameFace = 0.9;   // cosine
constexpr double kWeakShare = 0.1;  // of the best known direction's information
// Neighbouring points share their errors: count them as fewer.
constexpr double kIndependentShare = 0.25;

WallPoint column_point(const CameraFrame& frame, const CameraModel& camera,
                       const Se3& base_from_camera, const SlamConfig& config, int u,
                       std::vector<double>& depths) {
  depths.clear();
  for (int v = 0; v < frame.depth.rows; v += kRowStep) {
    const double z = frame.depth.at<std::uint16_t>(v, u) * frame.depth_unit_m;
    if (z < config.depth.min_depth_m || z > config.depth.max_depth_m) continue;
    const Eigen::Vector3d p = base_from_camera * camera.unproject(camera.undistort({u, v}), z);
    if (p.z() < 2.0 * config.grid.obstacle_min_height_m ||
        p.z() > config.grid.obstacle_max_height_m) {
      continue;
    }
    depths.push_back(z);
  }
  WallPoint out;
  if (depths.size() < kMinRows) return out;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  const double z = *middle;
  // The optical axis is level enough here that a column's depth is one distance over the floor.
  const Eigen::Vector3d p =
      base_from_camera * camera.unproject(camera.undistort({u, camera.height() / 2}), z);
  const double sigma = config.depth.sigma_at_1m_m * z * z;
  out.point = p.head<2>().cast<float>();
  // The median of n readings spreads 1.25 / sqrt(n) times as wide as one.
  out.sigma_m = static_cast<float>(1.25 * sigma / std::sqrt(static_cast<double>(depths.size())));
  return out;
}

/// Fits a line through a point's neighbours; leaves the normal zero where there is none.
void find_normal(WallScan& scan, std::size_t i, const Eigen::Vector2f& eye) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  const auto size = static_cast<std::ptrdiff_t>(scan.size());
  Eigen::Vector2f mean = Eigen::Vector2f::Zero();
  Eigen::Matrix2f spread = Eigen::Matrix2f::Zero();
  int n = 0;
  for (auto k = std::max<std::ptrdiff_t>(0, at - kNeighbours);
       k <= std::min(size - 1, at + kNeighbours); ++k) {
    const Eigen::Vector2f d = scan[static_cast<std::size_t>(k)].point - scan[i].point;
    if (d.norm() > kNeighbourM) continue;
    mean += d;
    spread += d * d.transpose();
    ++n;
  }
  if (n < 5) return;
  mean /= static_cast<float>(n);
  spread = spread / static_cast<float>(n) - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> eigen(spread);
  const float across = std::sqrt(std::max(0.0f, eigen.eigenvalues()(0)));
  const float along = std::sqrt(std::max(0.0f, eigen.eigenvalues()(1)));
  const Eigen::Vector2f normal = eigen.eigenvectors().col(0);
  const float grazing = std::abs(normal.dot((scan[i].point - eye).normalized()));
  const float sigma = std::hypot(scan[i].sigma_m * grazing, static_cast<float>(kSystematicM));
  if (across > 2.0f * sigma + 0.01f || along < 2.0f * across) return;
  scan[i].normal = normal.dot(scan[i].point - eye) < 0 ? normal : Eigen::Vector2f(-normal);
  scan[i].sigma_across_m = sigma;
}

struct MapPoint {
  Eigen::Vector2d point, normal;
  double variance = 0.0;
};

std::vector<MapPoint> in_map(const std::vector<PlacedWalls>& scans) {
  std::vector<MapPoint> out;
  for (const PlacedWalls& placed : scans) {
    const Eigen::Rotation2Dd turn(placed.map_from_base.phi);
    const Eigen::Vector2d at(placed.map_from_base.x, placed.map_from_base.y);
    for (const WallPoint& p : *placed.scan) {
      if (p.normal.isZero()) continue;
      out.push_back({turn * p.point.cast<double>() + at, turn * p.normal.cast<double>(),
                     std::pow(p.sigma_across_m, 2)});
    }
  }
  return out;
}

const MapPoint* nearest(const std::vector<MapPoint>& reference, const Eigen::Vector2d& point) {
  const MapPoint* best = nullptr;
  double best_squared = kCorrespondM * kCorrespondM;
  for (const MapPoint& r : reference) {
    const double squared = (r.point - point).squaredNorm();
    if (squared < best_squared) {
      best_squared = squared;
      best = &r;
    }
  }
  return best;
}

/// Noise in the normals makes parallel walls claim a little knowledge along them, always in favour
/// of no motion. A direction that weak is left out (Zhang, Kaess & Singh 2016).
void drop_weak_direction(PlanarCost& cost) {
  const Eigen::Matrix2d translation = cost.information.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(translation);
  if (eigen.eigenvalues()(0) > kWeakShare * eigen.eigenvalues()(1)) return;
  const Eigen::Vector2d weak = eigen.eigenvectors().col(0);
  Eigen::Matrix3d keep = Eigen::Matrix3d::Identity();
  keep.topLeftCorner<2, 2>() -= weak * weak.transpose();
  cost.information = keep * cost.information * keep;
  cost.gradient = keep * cost.gradient;
}

PlanarCost linearize(const std::vector<MapPoint>& reference, const WallScan& scan,
                     const TPose2D& pose) {
  PlanarCost out;
  const Eigen::Rotation2Dd turn(pose.phi);
  for (const WallPoint& p : scan) {
    if (p.normal.isZero()) continue;
    const Eigen::Vector2d arm = turn * p.point.cast<double>();
    const MapPoint* wall = nearest(reference, arm + Eigen::Vector2d(pose.x, pose.y));
    if (wall == nullptr) continue;
    const Eigen::Vector2d own_normal = turn * p.normal.cast<double>();
    if (own_normal.dot(wall->normal) < kSameFace) continue;  // round a corner, or a wall's back
    ++out.points;
    const double error = wall->normal.dot(arm + Eigen::Vector2d(pose.x, pose.y) - wall->point);
    const double variance = wall->variance + std::pow(p.sigma_across_m, 2);
    const double normalized = error / std::sqrt(variance);
    out.inliers += std::abs(normalized) < kInlierSigmas;
    const double ratio = normalized / kCauchyScale;
    const double weight = kIndependentShare / (variance * (1.0 + ratio * ratio));
    const Eigen::Vector3d jacobian(wall->normal.x(), wall->normal.y(),
                                   wall->normal.dot(Eigen::Vector2d(-arm.y(), arm.x())));
    out.information += weight * jacobian * jacobian.transpose();
    out.gradient += weight * error * jacobian;
  }
  drop_weak_direction(out);
  return out;
}

}  // namespace

int common_points(const PlacedWalls& one, const PlacedWalls& other) {
  const std::vector<MapPoint> reference = in_map({one});
  int count = 0;
  for (const MapPoint& p : in_map({other})) {
    const MapPoint* wall = nearest(reference, p.point);
    count += wall != nullptr && p.normal.dot(wall->normal) >= kSameFace;
  }
  return count;
}

WallScan wall_scan(const CameraFrame& frame, const CameraModel& camera, const Se3& base_from_camera,
                   const SlamConfig& config) {
  WallScan scan;
  std::vector<double> depths;
  for (int u = kColumnStep / 2; u < frame.depth.cols; u += kColumnStep) {
    const WallPoint p = column_point(frame, camera, base_from_camera, config, u, depths);
    if (p.sigma_m > 0) scan.push_back(p);
  }
  const Eigen::Vector2f eye = base_from_camera.translation.head<2>().cast<float>();
  for (std::size_t i = 0; i < scan.size(); ++i) find_normal(scan, i, eye);
  return scan;
}

WallMatch match_walls(const std::vector<PlacedWalls>& reference, const WallScan& scan,
                      const TPose2D& prior, const Eigen::Matrix3d& prior_covariance) {
  const std::vector<MapPoint> walls = in_map(reference);
  const PlanarFit fit = fit_planar(prior, prior_covariance, kIterations, [&](const TPose2D& pose) {
    return linearize(walls, scan, pose);
  });
  WallMatch match;
  match.look = fit.look;
  match.points = fit.points;
  match.inlier_share = fit.inlier_share();
  return match;
}

}  // namespace rovigo::slam
