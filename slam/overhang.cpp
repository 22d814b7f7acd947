#include "slam/overhang.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kReachM = 1.0;  // from an edge: half of the largest table, and something over
constexpr int kDirections = 32;  // asked around a cell
constexpr int kWidestGap = 17;   // of them, between neighbouring edges: half of them, and noise
constexpr std::int8_t kInferred = 80;  // percent
constexpr int kNone = -1;

int lowest_bit(std::uint16_t bits) {
  int b = 0;
  while (((bits >> b) & 1U) == 0U) ++b;
  return b;
}

/// The band of the underside of what hangs in a cell (occupied, free below); kNone where nothing
/// does.
int underside(const CellBands& c) {
  if (c.occupied == 0) return kNone;
  const int low = lowest_bit(c.occupied);
  return (c.free & ((1U << low) - 1U)) != 0U ? low : kNone;
}

/// Crossed by rays below a height that hides: nothing occupied, not all of the upper half free, and
/// something below the first gap free.
bool is_under_something(const CellBands& c) {
  const std::uint16_t gaps = kUpperBands & static_cast<std::uint16_t>(~c.free);
  if (c.occupied != 0 || gaps == 0) return false;
  return (c.free & ((1U << lowest_bit(gaps)) - 1U)) != 0U;
}

/// The underside of the edge that a walk under cover ends at; kNone where it ends at none.
int edge_ahead(const std::vector<CellBands>& bands, const maps::GridGeometry& g, maps::Cell from,
               const TPoint2D& direction) {
  const int farthest = static_cast<int>(kReachM / g.resolution_m);
  for (int i = 1; i <= farthest; ++i) {
    const maps::Cell c{from.x + static_cast<int>(std::lround(i * direction.x)),
                       from.y + static_cast<int>(std::lround(i * direction.y))};
    if (!g.contains(c)) return kNone;
    const CellBands& at = bands[g.index_of(c)];
    if (at.occupied != 0) return underside(at);
    if (!is_under_something(at)) return kNone;
  }
  return kNone;
}

using Directions = std::bitset<kDirections>;

int widest_gap(const Directions& edges) {
  if (edges.none()) return kDirections;
  int widest = 0, gap = 0;
  for (std::size_t i = 0; i < 2 * kDirections; ++i) {  // twice around: a gap may span the start
    gap = edges[i % kDirections] ? 1 : gap + 1;
    widest = std::max(widest, gap);
  }
  return widest;
}

/// Edges of one level stand all around the cell, as far as it is hidden at their height.
bool is_amid_edges(const std::vector<CellBands>& bands, const maps::GridGeometry& g,
                   std::size_t cell, const std::array<TPoint2D, kDirections>& directions) {
  std::array<Directions, kHeightBands + 1> edges;  // by the band of their underside
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const int band = edge_ahead(bands, g, g.cell_of(cell), directions[i]);
    if (band == kNone || ((bands[cell].free >> band) & 1U) != 0U) continue;
    edges[static_cast<std::size_t>(band)].set(i);
  }
  for (std::size_t band = 0; band < kHeightBands; ++band) {
    // One top's edges may fall on two neighbouring bands.
    if (widest_gap(edges[band] | edges[band + 1]) <= kWidestGap) return true;
  }
  return false;
}

}  // namespace

void fill_overhangs(const std::vector<CellBands>& bands, maps::OccupancyGrid& grid) {
  std::array<TPoint2D, kDirections> directions;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double angle = 2.0 * maps::kPi * static_cast<double>(i) / kDirections;
    directions[i] = {std::cos(angle), std::sin(angle)};
  }
  for (std::size_t i = 0; i < bands.size(); ++i) {
    if (is_under_something(bands[i]) && is_amid_edges(bands, grid.geometry, i, directions)) {
      grid.cells[i] = kInferred;
    }
  }
}

}  // namespace rovigo::slam
