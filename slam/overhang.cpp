#include "slam/overhang.h"

#include <array>

namespace rovigo::slam {

namespace {

constexpr double kLongestTopM = 1.5;
constexpr std::int8_t kInferred = 80;  // percent

int lowest_bit(std::uint16_t bits) {
  int b = 0;
  while (((bits >> b) & 1U) == 0U) ++b;
  return b;
}

/// Occupied above, free below.
bool hangs(const CellBands& c) {
  if (c.occupied == 0) return false;
  const int low = lowest_bit(c.occupied);
  return (c.free & ((1U << low) - 1U)) != 0U;
}

/// Crossed by rays below a height that hides: nothing occupied, not all of the upper half free, and
/// something below the first gap free.
bool is_under_something(const CellBands& c) {
  const std::uint16_t gaps = kUpperBands & static_cast<std::uint16_t>(~c.free);
  if (c.occupied != 0 || gaps == 0) return false;
  return (c.free & ((1U << lowest_bit(gaps)) - 1U)) != 0U;
}

}  // namespace

void fill_overhangs(const std::vector<CellBands>& bands, maps::OccupancyGrid& grid) {
  constexpr std::array<maps::Cell, 4> kAxes = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  const maps::GridGeometry& g = grid.geometry;
  const int reach = static_cast<int>(kLongestTopM / g.resolution_m);
  // What stands at the end of a walk under cover: 0 nothing, 1 an obstacle, 2 one that hangs.
  const auto end_of_cover = [&](maps::Cell c, maps::Cell d) {
    for (int i = 0; i < reach; ++i) {
      c = {c.x + d.x, c.y + d.y};
      if (!g.contains(c)) return 0;
      const CellBands& at = bands[g.index_of(c)];
      if (at.occupied != 0) return hangs(at) ? 2 : 1;
      if (!is_under_something(at)) return 0;
    }
    return 0;
  };
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (!is_under_something(bands[i])) continue;
    const maps::Cell c = g.cell_of(i);
    for (const maps::Cell& d : kAxes) {
      const int ahead = end_of_cover(c, d);
      if (ahead == 0) continue;
      const int behind = end_of_cover(c, {-d.x, -d.y});
      if (ahead + behind < 4) continue;
      grid.cells[i] = kInferred;
      break;
    }
  }
}

}  // namespace rovigo::slam
