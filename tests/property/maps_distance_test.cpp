// Distances and safe inflation against brute force, on random grids.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "maps/distance_field.h"
#include "maps/inflation.h"

namespace rovigo::maps {
namespace {

OccupancyGrid random_grid(std::mt19937_64& rng) {
  std::uniform_int_distribution<int> side(1, 45);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double density = std::pow(10.0, -3.5 * unit(rng));
  OccupancyGrid grid({0.02 + 0.2 * unit(rng), {-3.0 * unit(rng), unit(rng)}, side(rng), side(rng)},
                     OccupancyGrid::kFree);
  for (auto& cell : grid.cells) {
    const double u = unit(rng);
    cell = u < density ? OccupancyGrid::kOccupied : u > 0.9 ? OccupancyGrid::kUnknown : cell;
  }
  return grid;
}

/// The definition, spelled out: the nearest of all occupied squares.
double brute_force(const OccupancyGrid& grid, const TPoint2D& p) {
  const GridGeometry& g = grid.geometry;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!OccupancyGrid::is_occupied(grid.cells[i])) continue;
    const TPoint2D c = g.center_of(g.cell_of(i));
    const double dx = std::max(std::abs(p.x - c.x) - 0.5 * g.resolution_m, 0.0);
    const double dy = std::max(std::abs(p.y - c.y) - 0.5 * g.resolution_m, 0.0);
    best = std::min(best, std::hypot(dx, dy));
  }
  return best;
}

class RandomGrids : public testing::TestWithParam<std::uint64_t> {
 protected:
  std::mt19937_64 rng_{GetParam()};
  OccupancyGrid grid_ = random_grid(rng_);
};

TEST_P(RandomGrids, DistanceFieldEqualsBruteForce) {
  const DistanceField field = distance_to_occupied(grid_);
  for (std::size_t i = 0; i < grid_.cells.size(); ++i) {
    const double expected = brute_force(grid_, grid_.geometry.center_of(grid_.geometry.cell_of(i)));
    if (std::isinf(expected)) {
      EXPECT_TRUE(std::isinf(field.meters[i]));
    } else {
      EXPECT_NEAR(field.meters[i], expected, 1e-6 * (1.0 + expected)) << "cell " << i;
    }
  }
}

TEST_P(RandomGrids, ClearanceEqualsBruteForceAnywhere) {
  const DistanceField field = distance_to_occupied(grid_);
  const GridGeometry& g = grid_.geometry;
  std::uniform_real_distribution<double> along(-0.3, 1.3);
  std::uniform_real_distribution<double> limit(0.0, 6.0);
  for (int i = 0; i < 200; ++i) {
    const TPoint2D p{g.origin.x + along(rng_) * g.width * g.resolution_m,
                     g.origin.y + along(rng_) * g.height * g.resolution_m};
    const double limit_m = limit(rng_);
    EXPECT_NEAR(clearance_at(grid_, field, p, limit_m), std::min(brute_force(grid_, p), limit_m),
                1e-9)
        << p.x << ", " << p.y;
  }
}

TEST_P(RandomGrids, ExactlyTheCellsNearerThanTheRadiusAreLethal) {
  std::uniform_real_distribution<double> any(0.0, 1.5);
  const InflationConfig config{.robot_radius_m = any(rng_), .soft_cost_sigma_m = 0.2 * any(rng_)};
  const Costmap map = inflate_safe(grid_, config);
  for (std::size_t i = 0; i < grid_.cells.size(); ++i) {
    const double d = brute_force(grid_, grid_.geometry.center_of(grid_.geometry.cell_of(i)));
    const bool occupied = OccupancyGrid::is_occupied(grid_.cells[i]);
    EXPECT_EQ(map.cells[i] == Costmap::kLethal, occupied || d < config.robot_radius_m)
        << "cell " << i << " at " << d << " m, radius " << config.robot_radius_m;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomGrids, testing::Range<std::uint64_t>(1, 61));

}  // namespace
}  // namespace rovigo::maps
