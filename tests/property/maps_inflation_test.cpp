// Costmaps brought up to date against costmaps made anew, byte for byte.

#include <gtest/gtest.h>

#include <random>

#include "maps/error.h"
#include "maps/inflation.h"

namespace rovigo::maps {
namespace {

OccupancyGrid random_grid(std::mt19937_64& random) {
  OccupancyGrid grid({0.05,
                      {0.0, 0.0},
                      1 + static_cast<int>(random() % 120),
                      1 + static_cast<int>(random() % 120)},
                     OccupancyGrid::kFree);
  const auto rarity = 10 + random() % 200;
  for (auto& cell : grid.cells) {
    if (random() % rarity == 0) cell = OccupancyGrid::kOccupied;
    if (random() % rarity == 0) cell = OccupancyGrid::kUnknown;
  }
  return grid;
}

/// Changes cells within a rectangle, which may stick out of the grid; sometimes clears it.
CellRect change_part(std::mt19937_64& random, OccupancyGrid& grid) {
  const auto side = [&](int size) {
    const int begin = static_cast<int>(random() % static_cast<unsigned>(size + 4)) - 2;
    return std::pair{begin, begin + static_cast<int>(random() % 12)};
  };
  const auto [x0, x1] = side(grid.geometry.width);
  const auto [y0, y1] = side(grid.geometry.height);
  const bool clear = random() % 3 == 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      if (!grid.geometry.contains(Cell{x, y})) continue;
      grid.at({x, y}) = clear               ? OccupancyGrid::kFree
                        : random() % 4 == 0 ? OccupancyGrid::kOccupied
                                            : static_cast<std::int8_t>(random() % 102 - 1);
    }
  }
  return {{x0, y0}, {x1, y1}};
}

TEST(UpdatedCostmap, IsThatOfInflatingAnewInSafeMode) {
  std::mt19937_64 random(31);
  std::size_t changed_maps = 0;
  for (int i = 0; i < 300; ++i) {
    OccupancyGrid grid = random_grid(random);
    const InflationConfig config{
        .robot_radius_m = 0.01 * static_cast<double>(random() % 60),
        .soft_cost_sigma_m = random() % 3 == 0 ? 0.0 : 0.01 * static_cast<double>(random() % 40),
        .soft_cost_peak = static_cast<int>(random() % 253),
        .map_mode = static_cast<MapMode>(random() % 3)};
    Costmap costmap = inflate_safe(grid, config);
    const Costmap before = costmap;
    for (int change = 0; change < 3; ++change) {
      const CellRect changed = change_part(random, grid);
      update_safe(grid, changed, config, costmap);
      ASSERT_EQ(costmap.cells, inflate_safe(grid, config).cells) << "map " << i;
    }
    if (costmap.cells != before.cells) ++changed_maps;
  }
  EXPECT_GT(changed_maps, 100U);
}

TEST(UpdatedCostmap, IsThatOfInflatingAnewInReferenceMode) {
  std::mt19937_64 random(32);
  std::size_t changed_maps = 0;
  for (int i = 0; i < 300; ++i) {
    OccupancyGrid grid = random_grid(random);
    const double sigma = 0.25 * static_cast<double>(random() % 24);
    const auto mode = static_cast<MapMode>(random() % 3);
    Costmap costmap = inflate_reference(grid, sigma, mode);
    const Costmap before = costmap;
    for (int change = 0; change < 3; ++change) {
      const CellRect changed = change_part(random, grid);
      update_reference(grid, changed, sigma, mode, costmap);
      ASSERT_EQ(costmap.cells, inflate_reference(grid, sigma, mode).cells)
          << "map " << i << " sigma " << sigma;
    }
    if (costmap.cells != before.cells) ++changed_maps;
  }
  EXPECT_GT(changed_maps, 100U);
}

TEST(UpdatedCostmap, OfAnotherSizeIsRefused) {
  const OccupancyGrid grid({0.05, {0.0, 0.0}, 5, 5}, OccupancyGrid::kFree);
  Costmap costmap({0.05, {0.0, 0.0}, 5, 4});
  EXPECT_THROW(update_safe(grid, {{0, 0}, {1, 1}}, {}, costmap), InputError);
  EXPECT_THROW(update_reference(grid, {{0, 0}, {1, 1}}, 2.0, MapMode::kKnownFree, costmap),
               InputError);
}

}  // namespace
}  // namespace rovigo::maps
