#include "planning/astar.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "planning/descent.h"
#include "planning/move_order.h"
#include "planning/step_prices.h"

namespace rovigo::planning {

namespace {

constexpr double kHeuristicLimit = 3.0e9;  // leaves room for the cost in 32 bits
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

/// One search: what does not change while it runs, and what it counts.
struct GridSearch::Query {
  const SearchGrid& grid;
  StepPrices prices;
  std::uint32_t start = 0;
  std::uint32_t goal = 0;
  int goal_x = 0;
  int goal_y = 0;
  double heuristic_weight = 1.0;
  std::size_t expanded = 0;
  bool overflow = false;

  std::uint32_t heuristic(int x, int y) const {
    const std::uint32_t h = prices.scale().octile(x - goal_x, y - goal_y);
    if (heuristic_weight == 1.0) return h;
    return static_cast<std::uint32_t>(std::min(h * heuristic_weight, kHeuristicLimit));
  }
  /// No single step raises cost plus heuristic by more.
  std::uint32_t step_limit() const {
    return prices.dearest_step() +
           static_cast<std::uint32_t>(prices.scale().diagonal * heuristic_weight);
  }
  /// Beyond this cost plus heuristic might not fit.
  std::uint32_t cost_limit() const {
    const auto& g = grid.geometry();
    const double farthest = heuristic_weight * prices.scale().octile(g.width, g.height);
    return kUnreached - step_limit() -
           static_cast<std::uint32_t>(std::min(kHeuristicLimit, farthest));
  }
};

void GridSearch::prepare(const SearchGrid& grid) {
  forget();
  if (cost_to_come_.size() != grid.padded_size()) {
    cost_to_come_.assign(grid.padded_size(), kUnreached);
  }
}

void GridSearch::forget() {
  for (const std::uint32_t cell : touched_) cost_to_come_[cell] = kUnreached;
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
    result.cost_m = static_cast<double>(cost_to_come_[query.goal]) / query.prices.scale().straight *
                    grid.geometry().resolution_m;
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

/// The moving parts of one run of A*.
template <bool soft>
struct GridSearch::Expansion {
  Query& query;
  const StepPrices& prices = query.prices;
  const std::uint8_t* moves = query.grid.moves();
  const std::uint8_t* soft_costs = query.grid.costs();
  const std::array<int, 8> offsets = query.grid.offsets();
  const int stride = query.grid.stride();
  const bool is_canonical = query.grid.has_every_move();
  std::uint32_t* cost_to_come;
  std::vector<std::uint32_t>& touched;
  BucketQueue<Entry>& open;
  std::uint32_t best = kUnreached;  ///< cost of the goal once it is reached

  std::uint8_t soft_cost(std::uint32_t cell) const { return soft ? soft_costs[cell] : 0; }
  bool may_prune(std::uint32_t cell) const {
    return is_canonical && (!soft || is_plain(soft_costs + cell, stride));
  }
  /// Does reaching the cell straight leave nothing to try but to go on?
  bool goes_on(std::uint32_t cell) const { return moves[cell] == 0xFF && may_prune(cell); }

  /// Tries these moves from a cell at x, y.
  void expand(std::uint32_t cell, std::uint32_t cost_here, int x, int y, unsigned tried) {
    ++query.expanded;
    for_each_move(tried, [&](std::size_t move) {
      const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      const std::uint32_t cost =
          cost_here + prices.step<soft>(move, soft_cost(cell), soft_cost(next));
      const std::uint32_t old = cost_to_come[next];
      if (cost >= old) return;
      const std::uint32_t total = cost + query.heuristic(x + kMoves[move].dx, y + kMoves[move].dy);
      if (total >= best) return;
      if (old == kUnreached) touched.push_back(next);
      cost_to_come[next] = cost;
      if (next == query.goal) {
        best = cost;
      } else {
        open.push(total, {next | static_cast<std::uint32_t>(move) << SearchGrid::kIndexBits, cost});
      }
    });
  }

  /// The same for a cell of open ground that a straight move led to, and for those behind it as long
  /// as they are due and open ground: most of all cells that are ever expanded.
  void go_on(std::uint32_t cell, std::uint32_t cost, int x, int y, std::size_t move) {
    constexpr int kAhead = 8;  // cells to fetch memory ahead
    for (;;) {
      ++query.expanded;
      cell = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      x += kMoves[move].dx;
      y += kMoves[move].dy;
      cost += prices.scale().straight;
      if (cost >= cost_to_come[cell]) return;
      const std::uint32_t total = cost + query.heuristic(x, y);
      if (total >= best) return;
      if (cost_to_come[cell] == kUnreached) touched.push_back(cell);
      cost_to_come[cell] = cost;
      if (cell == query.goal) {
        best = cost;
        return;
      }
      if (!open.is_due(total) || !goes_on(cell)) {
        open.push(total, {cell | static_cast<std::uint32_t>(move) << SearchGrid::kIndexBits, cost});
        return;
      }
      __builtin_prefetch(cost_to_come + static_cast<int>(cell) + kAhead * offsets[move], 1);
      __builtin_prefetch(moves + static_cast<int>(cell) + kAhead * offsets[move]);
    }
  }
};

template <bool soft>
bool GridSearch::run(Query& query) {
  const SearchGrid& grid = query.grid;
  Expansion<soft> expansion{.query = query,
                            .cost_to_come = cost_to_come_.data(),
                            .touched = touched_,
                            .open = open_};
  const maps::Cell start = grid.cell_of(query.start);
  open_.restart(query.heuristic(start.x, start.y), query.step_limit(),
                bucket_shift<soft>(query.prices.scale()));
  const std::uint32_t cost_limit = query.cost_limit();
  cost_to_come_[query.start] = 0;
  touched_.push_back(query.start);
  if (query.start == query.goal) return true;
  expansion.expand(query.start, 0, start.x, start.y, grid.moves()[query.start]);

  Entry entry{};
  // What waits behind the goal's cost cannot improve on it.
  while (open_.pop(expansion.best, entry)) {
    const std::uint32_t cell = entry.cell_and_move & kIndexMask;
    if (entry.cost != cost_to_come_[cell]) continue;  // improved since
    if (entry.cost > cost_limit) {
      query.overflow = true;
      return false;
    }
    const maps::Cell at = grid.cell_of(cell);
    // On open ground the goal shares its bucket with all cells of equally short ways.
    if (expansion.best != kUnreached &&
        entry.cost + query.heuristic(at.x, at.y) >= expansion.best) {
      continue;
    }
    const std::size_t move = entry.cell_and_move >> SearchGrid::kIndexBits;
    if (move < kStraightMoves && expansion.goes_on(cell)) {
      expansion.go_on(cell, entry.cost, at.x, at.y, move);
    } else {
      const MoveOrder& order = expansion.may_prune(cell) ? kCanonicalMoves : kEveryMove;
      expansion.expand(cell, entry.cost, at.x, at.y, order(move, grid.moves()[cell]));
    }
  }
  return expansion.best != kUnreached;
}

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

std::size_t GridSearch::memory_bytes() const {
  std::size_t bytes = (cost_to_come_.capacity() + touched_.capacity()) * sizeof(std::uint32_t);
  return bytes + open_.memory_bytes() + heap_.capacity() * sizeof(WeightedEntry) + expanded_.capacity() / 8;
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
