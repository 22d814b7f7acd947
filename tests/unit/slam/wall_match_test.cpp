#include "slam/wall_match.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/wall_scene.h"

namespace rovigo::slam {
namespace {

using test::scan_of;
using test::Wall;

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

TEST(WallMatch, TheBackOfAWallIsAnotherSurface) {
  const std::vector<Wall> face = {{{3, -3}, {3, 3}}}, back = {{{3.1, -3}, {3.1, 3}}};
  const WallScan before = scan_of(face, {0, 0, 0}, 7), now = scan_of(back, {6, 0, M_PI}, 8);
  EXPECT_EQ(match_walls({{&before, {0, 0, 0}}}, now, {6, 0, M_PI}, wide()).points, 0);
  EXPECT_EQ(common_points({&before, {0, 0, 0}}, {&now, {6, 0, M_PI}}), 0);
  EXPECT_GT(common_points({&before, {0, 0, 0}}, {&before, {0.1, 0, 0}}), 50);
}

TEST(WallMatch, AnEmptyScanIsNoWitness) {
  const WallMatch match = match_walls({}, {}, {1, 2, 0.5}, wide());
  EXPECT_EQ(match.points, 0);
  EXPECT_DOUBLE_EQ(match.look.map_from_base.x, 1.0);
  EXPECT_TRUE(match.look.information.isZero());
}

}  // namespace
}  // namespace rovigo::slam
