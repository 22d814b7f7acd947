#pragma once
// Tops on thin legs, seen edge-on: what lies between their edges is as much in the way as these.

#include <cstdint>
#include <vector>

#include "maps/occupancy_grid.h"
#include "slam/evidence_patch.h"

namespace rovigo::slam {

/// What is known of a cell's height bands, a bit a band, the lowest first.
struct CellBands {
  std::uint16_t occupied = 0;
  std::uint16_t free = 0;
};

/// A low thing would have stopped the rays below those that passed above it, but what hides above
/// free space (a table's top on its legs) may never get in a ray's way: only a cell whose upper
/// half was crossed is free.
inline constexpr std::uint16_t kUpperBands =
    ((1U << kHeightBands) - 1U) & ~((1U << (kHeightBands / 2)) - 1U);

/// Marks cells under a top as occupied: cells that rays crossed below while what is above was
/// hidden, with edges of a top of that height (few bands, free below) all around them, not farther
/// than a table reaches. A top is taken to be whole between its edges; a shadow behind it has edges
/// on one side only.
void fill_overhangs(const std::vector<CellBands>& bands, maps::OccupancyGrid& grid);

}  // namespace rovigo::slam
