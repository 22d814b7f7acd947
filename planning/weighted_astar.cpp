#include <algorithm>

#include "planning/astar_expansion.h"

namespace rovigo::planning {

/// With a weighted heuristic, cells that are opened again whenever their cost improves can be so
/// many that no end is in sight. None is: with a consistent heuristic and the least total first the
/// bound holds all the same (Likhachev, Gordon & Thrun, "ARA*", 2003).
template <bool soft>
bool GridSearch::run_weighted(Query& query) {
  const SearchGrid& grid = query.grid;
  const std::uint8_t* costs = grid.costs();
  const std::array<int, 8> offsets = grid.offsets();
  const std::uint32_t cost_limit = query.cost_limit();
  expanded_.assign(grid.padded_size(), false);
  heap_.clear();
  heap_.push_back({0, 0, query.start});
  cost_to_come_[query.start] = 0;
  touched_.push_back(query.start);
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const WeightedEntry entry = heap_.back();
    heap_.pop_back();
    if (entry.cost != cost_to_come_[entry.cell]) continue;  // improved since
    if (entry.cell == query.goal) return true;
    if (entry.cost > cost_limit) {
      query.overflow = true;
      return false;
    }
    ++query.expanded;
    expanded_[entry.cell] = true;
    const maps::Cell at = grid.cell_of(entry.cell);
    const std::uint8_t here = soft ? costs[entry.cell] : std::uint8_t{0};
    for_each_move(grid.moves()[entry.cell], [&](std::size_t move) {
      const auto next = static_cast<std::uint32_t>(static_cast<int>(entry.cell) + offsets[move]);
      const std::uint32_t cost =
          entry.cost + query.prices.step<soft>(move, here, soft ? costs[next] : std::uint8_t{0});
      if (cost >= cost_to_come_[next] || expanded_[next]) return;
      if (cost_to_come_[next] == kUnreached) touched_.push_back(next);
      cost_to_come_[next] = cost;
      const auto h = query.heuristic(at.x + kMoves[move].dx, at.y + kMoves[move].dy);
      heap_.push_back({cost + h, cost, next});
      std::push_heap(heap_.begin(), heap_.end());
    });
  }
  return false;
}

template bool GridSearch::run_weighted<false>(Query& query);
template bool GridSearch::run_weighted<true>(Query& query);

}  // namespace rovigo::planning
