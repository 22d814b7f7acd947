#pragma once
// What planners search: for every cell, whether the rover's centre may be there and at what price.

#include <cstdint>
#include <vector>

#include "maps/grid_geometry.h"

namespace rovigo::maps {

/// How cells that nobody has seen are treated (mission R6).
enum class MapMode {
  kKnownFree = 0,        ///< only known-free ground is passable
  kUnknownPassable = 1,  ///< unknown ground is passable too
  kEverything = 2,       ///< everything is passable
};

/// Traversal costs: kFree, soft costs 1 .. kMaxSoft, kLethal (never enter), kUnknown (not seen, and
/// impassable; unknown cells that the map mode lets through carry an ordinary cost instead).
struct Costmap {
  static constexpr std::uint8_t kFree = 0;
  static constexpr std::uint8_t kMaxSoft = 252;
  static constexpr std::uint8_t kLethal = 254;
  static constexpr std::uint8_t kUnknown = 255;

  GridGeometry geometry;
  std::vector<std::uint8_t> cells;

  Costmap() = default;
  explicit Costmap(const GridGeometry& g, std::uint8_t value = kFree)
      : geometry(g), cells(g.size(), value) {}

  std::uint8_t& at(Cell c) { return cells[geometry.index_of(c)]; }
  std::uint8_t at(Cell c) const { return cells[geometry.index_of(c)]; }
  static bool is_passable(std::uint8_t value) { return value <= kMaxSoft; }
  bool is_passable(Cell c) const { return geometry.contains(c) && is_passable(at(c)); }
};

}  // namespace rovigo::maps
