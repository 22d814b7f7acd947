#include "slam/wall_match.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rovigo::slam {
namespace {

using Eigen::Vector2d;

struct Wall {
  Vector2d from, to;
};

/// What a camera at `map_from_base` meets of the walls, with noise along the ray.
WallScan scan_of(const std::vector<Wall>& walls, const TPose2D& map_from_base, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  WallScan scan;
  for (int i = -60; i <= 60; ++i) {
    const double bearing = 0.0085 * i;
    const Vector2d ray(std::cos(map_from_base.phi + bearing),
                       std::sin(map_from_base.phi + bearing));
    double nearest = 6.0;
    Vector2d normal = Vector2d::Zero();
    for (const Wall& w : walls) {
      const Vector2d along = w.to - w.from;
      const Vector2d across(-along.y(), along.x());
      const double speed = ray.dot(across);
      if (std::abs(speed) < 1e-9) continue;
      const Vector2d eye(map_from_base.x, map_from_base.y);
      const double range = (w.from - eye).dot(across) / speed;
      const double share = (eye + range * ray - w.from).dot(along) / along.squaredNorm();
      if (range < 0.3 || range >= nearest || share < 0 || share > 1) continue;
      nearest = range;
      normal = Eigen::Rotation2Dd(-map_from_base.phi) * across.normalized();
    }
    if (normal.isZero()) continue;
    const double sigma = 0.0007 * nearest * nearest;  // averaged over the rows of a column
    const double measured = nearest + sigma * noise(random);
    const double grazing = std::abs(normal.dot(Vector2d(std::cos(bearing), std::sin(bearing))));
    WallPoint p;
    p.point = (measured * Vector2d(std::cos(bearing), std::sin(bearing))).cast<float>();
    p.normal = normal.cast<float>();
    p.sigma_m = static_cast<float>(sigma);
    p.sigma_across_m = static_cast<float>(std::hypot(sigma * grazing, 0.004));
    scan.push_back(p);
  }
  return scan;
}

const std::vector<Wall> kCorridor = {{{-5, 1}, {30, 1}}, {{-5, -1}, {30, -1}}};
const std::vector<Wall> kDeadEnd = {{{-5, 1}, {4, 1}}, {{-5, -1}, {4, -1}}, {{4, -1}, {4, 1}}};

Eigen::Matrix3d wide() { return Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal(); }

TEST(WallMatch, CorridorWallsGiveHeadingAndSideButNotProgress) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TPose2D truth(0.4, 0.05, 0.03);
    const WallScan before = scan_of(kCorridor, {0, 0, 0}, seed);
    const WallScan now = scan_of(kCorridor, truth, 100 + seed);
    const TPose2D prior(0.47, 0.0, 0.0);  // the wheels' progress, slightly wrong
    const WallMatch match = match_walls({{&before, {0, 0, 0}}}, now, prior, wide());
    EXPECT_GT(match.points, 50) << "seed " << seed;
    EXPECT_GT(match.inlier_share, 0.9) << "seed " << seed;
    EXPECT_NEAR(match.look.map_from_base.phi, truth.phi, 0.003) << "seed " << seed;
    EXPECT_NEAR(match.look.map_from_base.y, truth.y, 0.01) << "seed " << seed;
    EXPECT_NEAR(match.look.map_from_base.x, prior.x, 0.005) << "seed " << seed;
    EXPECT_LT(match.look.information(0, 0), 1e-3 * match.look.information(1, 1));
  }
}

TEST(WallMatch, AWallAcrossTheEndGivesProgressToo) {
  const TPose2D truth(0.3, -0.04, -0.02);
  const WallScan before = scan_of(kDeadEnd, {0, 0, 0}, 3);
  const WallScan now = scan_of(kDeadEnd, truth, 4);
  const WallMatch match = match_walls({{&before, {0, 0, 0}}}, now, {0.35, 0, 0}, wide());
  EXPECT_NEAR(match.look.map_from_base.x, truth.x, 0.01);
  EXPECT_NEAR(match.look.map_from_base.y, truth.y, 0.01);
  EXPECT_NEAR(match.look.map_from_base.phi, truth.phi, 0.003);
}

TEST(WallMatch, WallsElsewhereMatchNothing) {
  const WallScan before = scan_of(kCorridor, {0, 0, 0}, 5);
  const std::vector<Wall> hall = {{{-5, 3}, {30, 3}}, {{-5, -3}, {30, -3}}};
  const WallMatch match =
      match_walls({{&before, {0, 0, 0}}}, scan_of(hall, {0, 0, 0}, 6), {0, 0, 0}, wide());
  EXPECT_EQ(match.points, 0);
}

TEST(WallMatch, AnEmptyScanIsNoWitness) {
  const WallMatch match = match_walls({}, {}, {1, 2, 0.5}, wide());
  EXPECT_EQ(match.points, 0);
  EXPECT_DOUBLE_EQ(match.look.map_from_base.x, 1.0);
  EXPECT_TRUE(match.look.information.isZero());
}

}  // namespace
}  // namespace rovigo::slam
