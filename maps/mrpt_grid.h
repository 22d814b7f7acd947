#pragma once
// MRPT's grids hold the probability that a cell is free; ours that it is occupied. The one place
// that converts between them.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// MRPT's value, 0 .. 1, for one of ours; unknown is 0.5.
inline float mrpt_free_probability(std::int8_t occupancy) {
  if (OccupancyGrid::is_unknown(occupancy)) return 0.5F;
  return 1.0F - 0.01F * static_cast<float>(std::clamp<std::int8_t>(occupancy, 0, 100));
}

/// Our value for one of MRPT's. MRPT rounds to log-odds, so what lies within 0.02 of 0.5 is
/// unknown; ours of 48 to 52 come back as unknown.
inline std::int8_t occupancy_from_mrpt(float free_probability) {
  if (!(std::abs(free_probability - 0.5F) > 0.02F)) return OccupancyGrid::kUnknown;
  const float occupied = std::clamp(1.0F - free_probability, 0.0F, 1.0F);
  return static_cast<std::int8_t>(std::lround(100.0F * occupied));
}

}  // namespace rovigo::maps
