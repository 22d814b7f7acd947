#pragma once
// Theta*: ways that leave the grid's eight directions.

#include <cstdint>
#include <functional>
#include <vector>

#include "planning/astar.h"

namespace rovigo::planning {

/// May one go straight from the centre of one cell to that of another? Every move between the cells
/// that the line enters must be open; where it runs exactly through a corner, all four cells around
/// the corner must be connected. Exact, in integers.
bool line_of_sight(const SearchGrid& grid, maps::Cell from, maps::Cell to);

/// Nash, Daniel, Koenig & Felner, "Theta*: any-angle path planning on grids" (2007), lazy as in
/// Nash, Koenig & Tovey 2010: a cell's straight line to its parent is looked at only when the cell
/// is its turn. Unlike both, cells whose way improves are opened again, so the way found is never
/// longer than A*'s on the grid. Lengths only: soft costs are not looked at.
class AnyAngleSearch {
 public:
  /// Asked about every straight line longer than one move, once the grid lets it through.
  using LineTest = std::function<bool(maps::Cell, maps::Cell)>;

  /// `cells` of the result are the turning points, start and goal included. Lines longer than one
  /// move must pass `also_free` where it is given.
  GridSearchResult find(const SearchGrid& grid, maps::Cell start, maps::Cell goal,
                        const LineTest& also_free = {});

  /// Beyond the grid itself.
  std::size_t memory_bytes() const;

 private:
  struct Query;
  struct Entry {
    std::uint32_t cell;
    float length;
  };

  void prepare(const SearchGrid& grid);
  bool run(Query& query);
  bool confirm(const Query& query, std::uint32_t cell);
  void expand(Query& query, std::uint32_t cell);
  void offer(Query& query, std::uint32_t from, std::uint32_t to, float step);
  void set(Query& query, std::uint32_t cell, std::uint32_t parent, float length, bool confirmed);
  GridSearchResult collect(const Query& query) const;

  /// Cells from the start: of a real way where the cell is confirmed, else at best that.
  std::vector<float> length_;
  std::vector<std::uint32_t> parent_;  ///< and in the top bit whether its line is confirmed free
  std::vector<std::uint32_t> touched_;
  std::vector<std::vector<Entry>> buckets_;
};

}  // namespace rovigo::planning
