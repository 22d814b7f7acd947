// Distances and safe inflation against brute force, on random grids.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

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

/// Runs `check(rng, grid)` on random grids, each made from a seed that failures name.
template <class Check>
void on_random_grids(Check check) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 rng(seed);
    const OccupancyGrid grid = random_grid(rng);
    check(rng, grid);
  }
}

TEST(RandomGrids, DistanceFieldEqualsBruteForce) {
  on_random_grids([](std::mt19937_64&, const OccupancyGrid& grid) {
    const DistanceField field = distance_to_occupied(grid);
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
      const double expected = brute_force(grid, grid.geometry.center_of(grid.geometry.cell_of(i)));
      if (std::isinf(expected)) {
        EXPECT_TRUE(std::isinf(field.meters[i]));
      } else {
        EXPECT_NEAR(field.meters[i], expected, 1e-6 * (1.0 + expected)) << "cell " << i;
      }
    }
  });
}

TEST(RandomGrids, ClearanceEqualsBruteForceAnywhere) {
  on_random_grids([](std::mt19937_64& rng, const OccupancyGrid& grid) {
    const DistanceField field = distance_to_occupied(grid);
    const GridGeometry& g = grid.geometry;
    std::uniform_real_distribution<double> along(-0.3, 1.3);
    std::uniform_real_distribution<double> limit(0.0, 6.0);
    for (int i = 0; i < 200; ++i) {
      const TPoint2D p{g.origin.x + along(rng) * g.width * g.resolution_m,
                       g.origin.y + along(rng) * g.height * g.resolution_m};
      const double limit_m = limit(rng);
      EXPECT_NEAR(clearance_at(grid, field, p, limit_m), std::min(brute_force(grid, p), limit_m),
                  1e-9)
          << p.x << ", " << p.y;
    }
  });
}

TEST(RandomGrids, ExactlyTheCellsNearerThanTheRadiusAreLethal) {
  on_random_grids([](std::mt19937_64& rng, const OccupancyGrid& grid) {
    std::uniform_real_distribution<double> any(0.0, 1.5);
    const InflationConfig config{.robot_radius_m = any(rng), .soft_cost_sigma_m = 0.2 * any(rng)};
    const Costmap map = inflate_safe(grid, config);
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
      const double d = brute_force(grid, grid.geometry.center_of(grid.geometry.cell_of(i)));
      const bool occupied = OccupancyGrid::is_occupied(grid.cells[i]);
      EXPECT_EQ(map.cells[i] == Costmap::kLethal, occupied || d < config.robot_radius_m)
          << "cell " << i << " at " << d << " m, radius " << config.robot_radius_m;
    }
  });
}

}  // namespace
}  // namespace rovigo::maps
