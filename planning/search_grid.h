#pragma once
// What A* walks on: for every cell the moves it allows, in one byte, with a closed border around.

#include <array>
#include <cstdint>
#include <vector>

#include "maps/costmap.h"
#include "maps/occupancy_grid.h"

namespace rovigo::planning {

/// The eight moves, straight ones first; a cell's `moves` byte has bit d set when move d is open.
struct Move {
  int dx;
  int dy;
};
inline constexpr std::array<Move, 8> kMoves{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
inline constexpr int kStraightMoves = 4;  ///< moves below this index are straight

/// One byte of moves per cell, and the soft costs when there are any. A diagonal move is open only
/// where both cells beside it are passable, so no path squeezes through a diagonal gap or cuts a
/// corner. The array has a border of closed cells, so that no bounds need checking in the search.
class SearchGrid {
 public:
  /// `connectivity` is 4 or 8.
  SearchGrid(const maps::Costmap& costmap, int connectivity);
  /// The raw grid: free cells, and unknown ones where the map mode lets them through. Map mode
  /// kEverything opens every cell.
  SearchGrid(const maps::OccupancyGrid& grid, maps::MapMode map_mode, int connectivity);

  const maps::GridGeometry& geometry() const { return geometry_; }
  int stride() const { return geometry_.width + 2; }
  std::size_t padded_size() const { return moves_.size(); }
  std::uint32_t index_of(maps::Cell c) const {
    return static_cast<std::uint32_t>((c.y + 1) * stride() + c.x + 1);
  }
  maps::Cell cell_of(std::uint32_t index) const {
    const int i = static_cast<int>(index);
    return {i % stride() - 1, i / stride() - 1};
  }
  /// Step in the padded array of every move.
  std::array<int, 8> offsets() const;

  const std::uint8_t* moves() const { return moves_.data(); }
  /// Soft costs, padded as `moves`; nullptr when every passable cell is free of cost.
  const std::uint8_t* costs() const { return costs_.empty() ? nullptr : costs_.data(); }
  bool is_passable(maps::Cell c) const {
    return geometry_.contains(c) && passable_[index_of(c)] != 0;
  }
  /// Eight neighbours, and no move closed by hand?
  bool has_every_move() const { return has_every_move_; }
  /// Closes one move in both directions (for gaps that prove narrower than the rover).
  void close_move(maps::Cell from, maps::Cell to);

  static constexpr int kIndexBits = 29;  ///< that an index of a cell takes at most

 private:
  void build_moves(int connectivity);

  maps::GridGeometry geometry_;
  bool has_every_move_ = true;
  std::vector<std::uint8_t> passable_;
  std::vector<std::uint8_t> moves_;
  std::vector<std::uint8_t> costs_;
};

}  // namespace rovigo::planning
