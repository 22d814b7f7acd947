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
constexpr int kWall = 8;          // and of a wall that is as low as a seat
constexpr std::int8_t kInferred = 80;  // percent

int lowest_bit(std::uint16_t bits) {
  int b = 0;
  while (((bits >> b) & 1U) == 0U) ++b;
  return b;
}

/// The bands of a top's edge in a cell: few, one above the other, free below. The front of a
/// cupboard on feet is no such edge, nor is what rays now and then get through: a leg, a wall's
/// outermost cell.
std::uint16_t edge_in(const CellBands& c) {
  if (c.occupied == 0 || std::popcount(c.occupied) > kThickestEdge) return 0;
  const int lowest = lowest_bit(c.occupied);
  const bool in_one = std::has_single_bit((c.occupied >> lowest) + 1U);
  return in_one && (c.free & ((1U << lowest) - 1U)) != 0U ? c.occupied : 0;
}

/// What is taller than an edge, a wall say, has a fringe that may look like one.
bool is_fringe(const std::vector<CellBands>& bands, const maps::GridGeometry& g, maps::Cell cell) {
  const std::uint16_t edge = bands[g.index_of(cell)].occupied;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const maps::Cell c{cell.x + dx, cell.y + dy};
      if (!g.contains(c)) continue;
      const std::uint16_t beside = bands[g.index_of(c)].occupied;
      if (std::popcount(beside) <= kThickestEdge) continue;
      if (beside >= 2U * std::bit_floor(edge) || std::popcount(beside) >= kWall) return true;
    }
  }
  return false;
}

std::uint16_t hidden_in(const CellBands& c) {
  return kUpperBands & static_cast<std::uint16_t>(~c.free);
}

/// Crossed by rays below a height that hides: nothing occupied, not all of the upper half free, and
/// something below the first gap free.
bool is_under_something(const CellBands& c) {
  const std::uint16_t gaps = hidden_in(c);
  if (c.occupied != 0 || gaps == 0) return false;
  return (c.free & ((1U << lowest_bit(gaps)) - 1U)) != 0U;
}

/// What of a walk's own hidden height the edge takes up that it ends at under cover; none where it
/// ends at no edge. A top's underside, seen from close by, is passed on the way.
std::uint16_t edge_ahead(const std::vector<CellBands>& bands, const maps::GridGeometry& g,
                         maps::Cell from, const TPoint2D& direction) {
  const std::uint16_t hidden = hidden_in(bands[g.index_of(from)]);
  const int farthest = static_cast<int>(kReachM / g.resolution_m);
  for (int i = 1; i <= farthest; ++i) {
    const maps::Cell c{from.x + static_cast<int>(std::lround(i * direction.x)),
                       from.y + static_cast<int>(std::lround(i * direction.y))};
    if (!g.contains(c)) return 0;
    const CellBands& at = bands[g.index_of(c)];
    const std::uint16_t edge = edge_in(at);
    if ((edge & hidden) != 0) return is_fringe(bands, g, c) ? 0 : edge & hidden;
    if (edge == 0 && !is_under_something(at)) return 0;
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

/// Edges of one level stand all around the cell, at a height that is hidden in it.
bool is_amid_edges(const std::vector<CellBands>& bands, const maps::GridGeometry& g,
                   std::size_t cell, const std::array<TPoint2D, kDirections>& directions) {
  std::array<Directions, kHeightBands + 1> edges;  // by their lowest band
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const std::uint16_t edge = edge_ahead(bands, g, g.cell_of(cell), directions[i]);
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
