#pragma once
// Jump point search: A* for uniform costs that leaps over all cells where nothing is decided.

#include <cstdint>
#include <vector>

#include "planning/astar.h"
#include "planning/bit_rows.h"
#include "planning/label_table.h"
#include "planning/step_scale.h"

namespace rovigo::planning {

/// Harabor & Grastien, "Online graph pruning for pathfinding on grid maps" (2011), in the form
/// without corner cutting; runs are scanned a word at a time and turning points on diagonals are
/// leapt over ("Improving jump point search", 2014). Diagonal runs go no further than is due, so
/// that those away from the goal cost little. Exact, for eight neighbours and equal costs; soft
/// costs and single closed moves of the grid are not looked at.
class JumpPointSearch {
 public:
  /// `grid` must outlive this.
  explicit JumpPointSearch(const SearchGrid& grid);

  /// The shortest way, as GridSearch::find gives it without soft costs. `expanded_cells` counts
  /// jump points. Reuses its workspace: not to be shared between threads.
  GridSearchResult find(maps::Cell start, maps::Cell goal);

  /// Beyond the grid itself.
  std::size_t memory_bytes() const;

 private:
  struct Query;
  struct Entry {
    std::uint32_t total;  ///< cost plus heuristic
    std::uint32_t cost;
    std::uint32_t cell;
    /// kArrived: a jump point to expand. Else a diagonal run that waits for its turn: where it
    /// comes from and its move, as in LabelTable::Label::before.
    std::uint32_t run;
    /// The heap's top is the greatest: the cheapest, among equals the one nearest to the goal.
    bool operator<(const Entry& other) const {
      return total != other.total ? total > other.total : cost < other.cost;
    }
  };

  bool run(Query& query);
  void expand(Query& query, std::uint32_t cell);
  void go_straight(Query& query, maps::Cell from, std::uint32_t cost, std::size_t move);
  void go_diagonal(Query& query, maps::Cell at, std::uint32_t cost, std::size_t move,
                   std::uint32_t last_due);
  void reach(Query& query, maps::Cell cell, std::uint32_t cost, std::size_t move);
  void collect_path(const Query& query, GridSearchResult& result) const;

  std::uint32_t index_of(maps::Cell c) const {
    return static_cast<std::uint32_t>(c.y) * static_cast<std::uint32_t>(geometry_.width) +
           static_cast<std::uint32_t>(c.x);
  }
  maps::Cell cell_of(std::uint32_t i) const {
    return {static_cast<int>(i % static_cast<std::uint32_t>(geometry_.width)),
            static_cast<int>(i / static_cast<std::uint32_t>(geometry_.width))};
  }
  bool is_open(int x, int y) const { return rows_.is_open(x, y); }

  const SearchGrid& grid_;
  maps::GridGeometry geometry_;
  BitRows rows_, columns_;
  /// `before` is the jump point before (a diagonal run leads from it, then a straight one), and in
  /// the top bits the move of arrival.
  LabelTable labels_;
  std::vector<Entry> open_;  ///< a heap
};

}  // namespace rovigo::planning
