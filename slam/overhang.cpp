#include "slam/overhang.h"

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cmath>

namespace rovigo::slam {

namespace {

constexpr double kReachM = 1.0;   // from an edge: half of the largest table, and something over
constexpr int kDirections = 32;   // asked around a cell
constexpr int kWidestGap = 17;    // of them, between neighbouring edges: half of them, and noise
constexpr int kThickestEdge = 3;  // bands
constexpr std::int8_t kInferred = 80;  // percent

int lowest_bit(std::uint16_t bits) {
  int b = 0;
  while (((bits >> b) & 1U) == 0U) ++b;
  return b;
}

/// The bands of a top's edge in a cell: few, occupied above a free one (below which a leg may
/// stand). The front of a cupboard on feet is no such edge.
std::uint16_t edge_in(const CellBands& c) {
  if (c.free == 0) return 0;
  const std::uint16_t up_to_free = (2U << lowest_bit(c.free)) - 1U;
  const auto edge = static_cast<std::uint16_t>(c.occupied & ~up_to_free);
  return std::popcount(edge) <= kThickestEdge ? edge : 0;
}

/// Crossed by rays below a height that hides: nothing occupied, not all of the upper half free, and
/// something below the first gap free.
bool is_under_something(const CellBands& c) {
  const std::uint16_t gaps = kUpperBands & static_cast<std::uint16_t>(~c.free);
  if (c.occupied != 0 || gaps == 0) return false;
  return (c.free & ((1U << lowest_bit(gaps)) - 1U)) != 0U;
}

/// The bands of the edge that a walk under cover ends at; none where it ends at no edge.
std::uint16_t edge_ahead(const std::vector<CellBands>& bands, const maps::GridGeometry& g,
                         maps::Cell from, const TPoint2D& direction) {
  const int farthest = static_cast<int>(kReachM / g.resolution_m);
  for (int i = 1; i <= farthest; ++i) {
    const maps::Cell c{from.x + static_cast<int>(std::lround(i * direction.x)),
                       from.y + static_cast<int>(std::lround(i * direction.y))};
    if (!g.contains(c)) return 0;
    const CellBands& at = bands[g.index_of(c)];
    if (at.occupied != 0) return edge_in(at);
    if (!is_under_something(at)) return 0;
  }
  return 0;
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

/// Edges of one level stand all around the cell, as far as it is hidden at about their height: a
/// top's edges and underside may fall on two neighbouring bands.
bool is_amid_edges(const std::vector<CellBands>& bands, const maps::GridGeometry& g,
                   std::size_t cell, const std::array<TPoint2D, kDirections>& directions) {
  const auto hidden = static_cast<std::uint16_t>(kUpperBands & ~bands[cell].free);
  const int about = hidden | hidden << 1 | hidden >> 1;
  std::array<Directions, kHeightBands + 1> edges;  // by their lowest band
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto edge =
        static_cast<std::uint16_t>(edge_ahead(bands, g, g.cell_of(cell), directions[i]) & about);
    if (edge != 0) edges[static_cast<std::size_t>(lowest_bit(edge))].set(i);
  }
  for (std::size_t band = 0; band < kHeightBands; ++band) {
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
