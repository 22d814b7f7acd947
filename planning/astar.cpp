#include "planning/astar.h"

#include <algorithm>
#include <bit>

#include "planning/astar_expansion.h"

namespace rovigo::planning {

namespace {

constexpr std::uint32_t kIndexMask = (std::uint32_t{1} << SearchGrid::kIndexBits) - 1;

/// Buckets narrow enough that order inside hardly matters: where a way is found that is cheaper by
/// less than a bucket, all that was expanded behind it is expanded again. Soft costs make many such
/// ways, equal costs hardly any.
template <bool soft>
int bucket_shift(const StepScale& scale) {
  constexpr int kBucketsPerStepLog2 = soft ? 6 : 3;
  return std::max(0, static_cast<int>(std::bit_width(scale.straight)) - 1 - kBucketsPerStepLog2);
}

}  // namespace

void GridSearch::prepare(const SearchGrid& grid) {
  forget();
  stride_ = grid.stride();
  if (cost_to_come_.size() != grid.padded_size()) {
    cost_to_come_.assign(grid.padded_size(), kUnreached);
  }
}

void GridSearch::forget() {
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    std::uint32_t cell = touched_[i] & kIndexMask;
    if (const std::uint32_t run = touched_[i] >> SearchGrid::kIndexBits; run != 0) {
      const int offset = kMoves[run - 1].dx + kMoves[run - 1].dy * stride_;
      for (std::uint32_t steps = touched_[++i]; steps > 0; --steps) {
        cell = static_cast<std::uint32_t>(static_cast<int>(cell) + offset);
        cost_to_come_[cell] = kUnreached;
      }
    } else {
      cost_to_come_[cell] = kUnreached;
    }
  }
  touched_.clear();
}

GridSearchResult GridSearch::find(const SearchGrid& grid, maps::Cell start, maps::Cell goal,
                                  const SearchWeights& weights) {
  GridSearchResult result;
  if (!grid.is_passable(start) || !grid.is_passable(goal)) return result;
  const bool soft = grid.costs() != nullptr && weights.soft_cost > 0.0;
  // Soft costs are made of halves of steps, which the first scale does not have.
  for (std::size_t attempt = soft ? 1 : 0; attempt < kStepScales.size(); ++attempt) {
    Query query{.grid = grid,
                .prices = StepPrices(kStepScales[attempt], soft ? weights.soft_cost : 0.0),
                .start = grid.index_of(start),
                .goal = grid.index_of(goal),
                .goal_x = goal.x,
                .goal_y = goal.y,
                .heuristic_weight = std::max(1.0, weights.heuristic)};
    prepare(grid);
    if (query.heuristic_weight > 1.0) {
      result.found = soft ? run_weighted<true>(query) : run_weighted<false>(query);
    } else {
      result.found = soft ? run<true>(query) : run<false>(query);
    }
    result.expanded_cells = query.expanded;
    if (query.overflow) continue;
    if (!result.found) return result;
    Descent way = soft ? descend<true>(grid, cost_to_come_, query.prices, query.goal)
                       : descend<false>(grid, cost_to_come_, query.prices, query.goal);
    std::reverse(way.cells.begin(), way.cells.end());
    result.cells = std::move(way.cells);
    result.length_m = way.length_m;
    result.cost_m = static_cast<double>(way.cost) / query.prices.scale().straight *
                    grid.geometry().resolution_m;
    return result;
  }
  result.found = false;
  return result;
}

template <bool soft>
bool GridSearch::run(Query& query) {
  const maps::Cell start = query.grid.cell_of(query.start);
  cost_to_come_[query.start] = 0;
  touched_.push_back(query.start);
  if (query.start == query.goal) return true;

  Expansion<soft> expansion{
      .query = query, .cost_to_come = cost_to_come_.data(), .touched = touched_, .open = open_};
  open_.restart(query.heuristic(start.x, start.y), query.rise_limit(),
                bucket_shift<soft>(query.prices.scale()));
  expansion.try_moves({query.start, 0, start.x, start.y, 0}, query.grid.moves()[query.start]);
  const std::uint32_t cost_limit = query.cost_limit();
  Entry next{};
  // What waits behind the goal's cost cannot improve on it.
  while (open_.pop(expansion.best, next)) {
    const std::uint32_t cell = next.cell_and_move & kIndexMask;
    if (next.cost != cost_to_come_[cell]) continue;  // improved since
    if (next.cost > cost_limit) {
      query.overflow = true;
      return false;
    }
    const maps::Cell at = query.grid.cell_of(cell);
    // On open ground the goal shares its bucket with all cells of equally short ways.
    if (next.cost + query.heuristic(at.x, at.y) >= expansion.best) continue;
    expansion.expand({cell, next.cost, at.x, at.y, next.cell_and_move >> SearchGrid::kIndexBits});
  }
  return expansion.best != kUnreached;
}

std::size_t GridSearch::memory_bytes() const {
  std::size_t bytes = (cost_to_come_.capacity() + touched_.capacity()) * sizeof(std::uint32_t);
  return bytes + open_.memory_bytes() + heap_.capacity() * sizeof(WeightedEntry) +
         expanded_.capacity() / 8;
}

std::optional<maps::Cell> GridSearch::nearest_reachable(const SearchGrid& grid, maps::Cell start,
                                                        const TPoint2D& target) {
  if (!grid.is_passable(start)) return std::nullopt;
  prepare(grid);
  const std::array<int, 8> offsets = grid.offsets();
  const auto distance_to = [&](std::uint32_t index) {
    const TPoint2D center = grid.geometry().center_of(grid.cell_of(index));
    return maps::distance(center, target);
  };
  // touched_ serves as the queue of a flood over straight moves: diagonal ones reach no more.
  touched_.push_back(grid.index_of(start));
  cost_to_come_[touched_.front()] = 0;
  std::uint32_t nearest = touched_.front();
  double nearest_distance = distance_to(nearest);
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    const std::uint32_t cell = touched_[i];
    const double d = distance_to(cell);
    if (d < nearest_distance || (d == nearest_distance && cell < nearest)) {
      nearest = cell;
      nearest_distance = d;
    }
    for (std::size_t move = 0; move < kStraightMoves; ++move) {
      if ((grid.moves()[cell] >> move & 1U) == 0) continue;
      const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      if (cost_to_come_[next] != kUnreached) continue;
      cost_to_come_[next] = 0;
      touched_.push_back(next);
    }
  }
  return grid.cell_of(nearest);
}

}  // namespace rovigo::planning
