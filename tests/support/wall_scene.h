#pragma once
// Upright walls, and what a depth camera on the rover meets of them.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "slam/wall_match.h"

namespace rovigo::test {

struct Wall {
  Eigen::Vector2d from, to;
};

/// What a camera at `map_from_base` meets of the walls, with noise along the ray.
inline slam::WallScan scan_of(const std::vector<Wall>& walls, const TPose2D& map_from_base,
                              std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  slam::WallScan scan;
  for (int i = -60; i <= 60; ++i) {
    const double bearing = 0.0085 * i;
    const Eigen::Vector2d ray(std::cos(map_from_base.phi + bearing),
                              std::sin(map_from_base.phi + bearing));
    double nearest = 6.0;
    Eigen::Vector2d normal = Eigen::Vector2d::Zero();
    for (const Wall& w : walls) {
      const Eigen::Vector2d along = w.to - w.from;
      const Eigen::Vector2d across(-along.y(), along.x());
      const double speed = ray.dot(across);
      if (std::abs(speed) < 1e-9) continue;
      const Eigen::Vector2d eye(map_from_base.x, map_from_base.y);
      const double range = (w.from - eye).dot(across) / speed;
      const double share = (eye + range * ray - w.from).dot(along) / along.squaredNorm();
      if (range < 0.3 || range >= nearest || share < 0 || share > 1) continue;
      nearest = range;
      normal = Eigen::Rotation2Dd(-map_from_base.phi) * across.normalized();
    }
    if (normal.isZero()) continue;
    if (normal.dot(Eigen::Vector2d(std::cos(bearing), std::sin(bearing))) > 0) normal = -normal;
    const double sigma = 0.0007 * nearest * nearest;  // averaged over the rows of a column
    const double measured = nearest + sigma * noise(random);
    const double grazing =
        std::abs(normal.dot(Eigen::Vector2d(std::cos(bearing), std::sin(bearing))));
    slam::WallPoint p;
    p.point = (measured * Eigen::Vector2d(std::cos(bearing), std::sin(bearing))).cast<float>();
    p.normal = normal.cast<float>();
    p.sigma_m = static_cast<float>(sigma);
    p.sigma_across_m = static_cast<float>(std::hypot(sigma * grazing, 0.004));
    scan.push_back(p);
  }
  return scan;
}

}  // namespace rovigo::test
