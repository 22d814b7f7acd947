#pragma once
// A* on a grid of moves, with soft costs; exact, deterministic, and lean enough for long queries.

#include <cstdint>
#include <optional>
#include <vector>

#include "planning/bucket_queue.h"
#include "planning/search_grid.h"

namespace rovigo::planning {

/// Weights of one search (see AStarConfig for the settings a person sees).
struct SearchWeights {
  double soft_cost = 0.0;  ///< a step at soft cost Costmap::kMaxSoft counts 1 + this times
  double heuristic = 1.0;  ///< 1: optimal; above: at most this factor from it
};

struct GridSearchResult {
  bool found = false;
  std::vector<maps::Cell> cells = {};  ///< from start to goal, both included; empty when not found
  double cost_m = 0.0;                 ///< length weighted by soft costs, metres
  double length_m = 0.0;               ///< of the polyline through the cell centres, metres
  std::size_t expanded_cells = 0;
};

/// Cost of a move between neighbours: its length times the mean of both cells' price, where a
/// cell's price is 1 + soft_cost * cost / kMaxSoft. With that the cost of a path is the trapezoid
/// rule for the integral of the price along it, and the same both ways.
///
/// Costs are integers in which a straight and a diagonal step stand in the ratio of a convergent of
/// sqrt 2, so that sums are exact, order cannot depend on rounding, and 32 bits suffice. The open
/// list is a ring of buckets a fraction of a step wide; inside a bucket the last in is the first
/// out, and a cell whose cost improves is put in again, which keeps the result exact. Where all
/// costs are equal, only the moves that MoveOrder leaves are tried, and runs over open ground
/// that leave just one are followed without waiting.
class GridSearch {
 public:
  /// The cheapest way from start to goal. Cells that are outside or impassable are not found.
  GridSearchResult find(const SearchGrid& grid, maps::Cell start, maps::Cell goal,
                        const SearchWeights& weights);

  /// Of the cells reachable from `start`, the one whose centre is nearest to `target` (the first in
  /// row order among equals); nullopt when start is impassable.
  std::optional<maps::Cell> nearest_reachable(const SearchGrid& grid, maps::Cell start,
                                              const TPoint2D& target);

  /// Beyond the grid itself.
  std::size_t memory_bytes() const;

 private:
  struct Entry {
    std::uint32_t cell_and_move;  ///< the move that led to the cell in the top bits
    std::uint32_t cost;
  };
  struct WeightedEntry {
    std::uint32_t total;  ///< cost plus weighted heuristic
    std::uint32_t cost;
    std::uint32_t cell;
    /// The heap's top is the greatest: the cheapest, among equals the one nearest to the goal.
    bool operator<(const WeightedEntry& other) const {
      return total != other.total ? total > other.total : cost < other.cost;
    }
  };
  struct Query;
  struct Visit;
  template <bool soft>
  struct Expansion;

  void prepare(const SearchGrid& grid);
  void forget();
  template <bool soft>
  bool run(Query& query);
  template <bool soft>
  bool run_weighted(Query& query);

  int stride_ = 0;                           ///< of the grid that touched_ is about
  std::vector<std::uint32_t> cost_to_come_;  ///< kUnreached except where a query has been
  /// Cells to clear before the next query: single ones, or a run of them, with its move plus one in
  /// the top bits, as two numbers (the cell before it, how many).
  std::vector<std::uint32_t> touched_;
  BucketQueue<Entry> open_;
  std::vector<WeightedEntry> heap_;
  std::vector<bool> expanded_;
};

}  // namespace rovigo::planning
