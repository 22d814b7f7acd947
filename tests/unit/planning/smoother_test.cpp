#include "planning/smoother.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/inflation.h"
#include "tests/unit/planning/grids.h"

namespace rovigo::planning {
namespace {

struct World {
  maps::OccupancyGrid grid;
  maps::Costmap costmap;
  FreeSpace space;
  explicit World(const maps::OccupancyGrid& g, double radius_m = 0.3)
      : grid(g),
        costmap(maps::inflate_safe(grid, {.robot_radius_m = radius_m})),
        space(grid, costmap, radius_m) {}
};

std::vector<PathPiece> smoothed(const World& world, std::vector<TPoint2D> polyline,
                                std::vector<std::size_t> pinned = {}) {
  SmoothingProblem problem;
  problem.polyline.points = std::move(polyline);
  problem.pinned = std::move(pinned);
  return smooth(world.space, problem, {});
}

double nearest(const Path& path, const TPoint2D& p) {
  double best = 1e9;
  for (const auto& q : path.points) best = std::min(best, maps::distance(p, q));
  return best;
}

TEST(Smoother, AStraightLineStaysStraight) {
  const auto pieces = smoothed(World(room(6, 6)), {{1, 1}, {5, 4}});
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_NEAR(length_m(sampled(pieces, 0.02)), 5.0, 1e-9);
}

TEST(Smoother, ACornerWithRoomIsOneCurveShorterThanTheCorner) {
  const World world(room(6, 6));
  const auto pieces = smoothed(world, {{1, 1}, {4, 1}, {4, 4}});
  ASSERT_EQ(pieces.size(), 1U);
  const Path path = sampled(pieces, 0.02);
  EXPECT_TRUE(is_free(world.space, path));
  EXPECT_LT(length_m(path), 5.95);
  EXPECT_NEAR(maps::distance(path.points.front(), {1, 1}), 0.0, 1e-12);
  EXPECT_NEAR(maps::distance(path.points.back(), {4, 4}), 0.0, 1e-12);
}

TEST(Smoother, GoesRoundThePillarAtTheCornerInsteadOfCuttingIt) {
  auto grid = room(6, 6);
  fill(grid, 3.4, 1.35, 3.65, 1.6);  // 0.35 m inside the corner at (4, 1)
  const World world(grid);
  ASSERT_TRUE(is_free(world.space, Path{{{1, 1}, {4, 1}, {4, 4}}}));
  const auto pieces = smoothed(world, {{1, 1}, {4, 1}, {4, 4}});
  EXPECT_EQ(pieces.size(), 1U);
  EXPECT_TRUE(is_free(world.space, sampled(pieces, 0.01)));
}

TEST(Smoother, CurvatureStaysWithinItsLimit) {
  const World world(room(6, 6));
  const SplineConfig config;
  const auto pieces = smoothed(world, {{1, 1}, {3, 1}, {3, 1.4}, {1.2, 1.4}, {1.2, 4}});
  for (const auto& piece : pieces) {
    for (const double u : sample_parameters(piece.curve, 0.01)) {
      EXPECT_LE(std::abs(piece.curve.at(u).curvature()), config.max_curvature_1_m * 1.01);
    }
  }
}

TEST(Smoother, PassesThroughPinnedPoints) {
  const World world(room(6, 6));
  const auto pieces = smoothed(world, {{1, 1}, {4, 1}, {4, 4}, {1, 4}}, {1, 2});
  const Path path = sampled(pieces, 0.005);
  EXPECT_LT(nearest(path, {4, 1}), 0.004);
  EXPECT_LT(nearest(path, {4, 4}), 0.004);
  EXPECT_EQ(pieces.size(), 1U);
}

TEST(Smoother, AUTurnIsMadeInPlace) {
  const World world(room(6, 6));
  const auto pieces = smoothed(world, {{1, 1}, {4, 1}, {1, 1.1}}, {1});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(maps::distance(pieces[0].curve.position(pieces[0].curve.end()), {4, 1}), 0.0, 1e-9);
}

TEST(Smoother, ATightZigZagBecomesTurnsInPlaceRatherThanScrapes) {
  // A corridor 0.65 m wide: one row of cells for a radius of 0.3 m; two sharp corners.
  auto grid = room(4, 4);
  fill(grid, 0.0, 0.0, 4.0, 4.0);
  const auto dig = [&](double x0, double y0, double x1, double y1) {
    fill(grid, x0, y0, x1, y1, maps::OccupancyGrid::kFree);
  };
  dig(0.2, 0.5, 2.3, 1.15);
  dig(1.65, 0.5, 2.3, 2.3);
  dig(1.65, 1.65, 3.5, 2.3);
  const World world(grid);
  const std::vector<TPoint2D> polyline{{0.6, 0.825}, {1.975, 0.825}, {1.975, 1.975}, {3.1, 1.975}};
  ASSERT_TRUE(is_free(world.space, Path{polyline}));
  const auto pieces = smoothed(world, polyline);
  EXPECT_GT(pieces.size(), 1U);
  EXPECT_TRUE(is_free(world.space, sampled(pieces, 0.01)));
}

TEST(Smoother, KeepsTheHeadingsAskedForWhereThereIsRoom) {
  const World world(room(6, 6));
  SmoothingProblem problem;
  problem.polyline.points = {{1, 1}, {5, 1}};
  problem.start_heading_rad = 0.4;
  problem.goal_heading_rad = -0.3;
  const auto pieces = smooth(world.space, problem, {});
  ASSERT_EQ(pieces.size(), 1U);
  const auto& curve = pieces[0].curve;
  EXPECT_NEAR(curve.at(curve.begin()).heading(), 0.4, 1e-9);
  EXPECT_NEAR(curve.at(curve.end()).heading(), -0.3, 1e-9);
  EXPECT_TRUE(is_free(world.space, sampled(pieces, 0.01)));
}

TEST(Smoother, GivesUpAHeadingThatLeadsIntoAWall) {
  const World world(room(6, 1.0));
  SmoothingProblem problem;
  problem.polyline.points = {{1, 0.36}, {5, 0.36}};
  problem.start_heading_rad = -0.5;
  const auto pieces = smooth(world.space, problem, {});
  EXPECT_TRUE(is_free(world.space, sampled(pieces, 0.01)));
}

TEST(Smoother, WithoutSmoothingThePolylineIsKept) {
  const World world(room(6, 6));
  SmoothingProblem problem;
  problem.polyline.points = {{1, 1}, {4, 1}, {4, 4}};
  const auto pieces = smooth(world.space, problem, {.smooth = false});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(length_m(sampled(pieces, 0.02)), 6.0, 1e-9);
}

}  // namespace
}  // namespace rovigo::planning
