#pragma once
// What a stretch of the way showed of its surroundings: evidence for and against obstacles, by cell
// and height, in a frame that hangs on one keyframe.

#include <array>
#include <cstdint>
#include <map>
#include <set>

#include "maps/grid_geometry.h"

namespace rovigo::slam {

/// Obstacle heights are told apart in so many bands: a ray contradicts an obstacle only at the
/// heights it crosses, so that what is seen below a table's top leaves the top in place.
inline constexpr int kHeightBands = 9;

/// Log-odds are kept in whole steps, so that sums do not depend on their order.
inline constexpr double kStepsPerLogOdds = 16.0;

/// Evidence of one cell, lowest band first; 0: none.
using CellEvidence = std::array<std::int8_t, kHeightBands>;

/// Sparse: memory follows what was seen. Cells count from the patch's own origin.
class EvidencePatch {
 public:
  static constexpr int kTileSide = 8;
  using Tile = std::array<CellEvidence, static_cast<std::size_t>(kTileSide) * kTileSide>;

  /// The tile that holds a cell, made when missing.
  Tile& tile_of(maps::Cell cell);
  static std::size_t place_in_tile(maps::Cell cell);

  /// Adds evidence, in steps; what one patch may claim is bounded, so that a world that changed is
  /// believed after a few looks (clamping: Yguel et al. 2007, as in OctoMap).
  static void add(std::int8_t& evidence, int steps);

  /// Something moved where this cell is: little evidence proves nothing around there.
  void doubt(maps::Cell cell) { doubted_.insert(index_of(cell)); }

  struct TileIndex {
    int y = 0, x = 0;
    friend auto operator<=>(const TileIndex&, const TileIndex&) = default;
  };
  static TileIndex index_of(maps::Cell cell);
  const std::map<TileIndex, Tile>& tiles() const { return tiles_; }
  bool is_doubted(TileIndex tile) const { return doubted_.count(tile) != 0; }
  std::size_t memory_bytes() const { return tiles_.size() * (sizeof(Tile) + sizeof(TileIndex)); }

 private:
  std::map<TileIndex, Tile> tiles_;
  std::set<TileIndex> doubted_;
};

}  // namespace rovigo::slam
