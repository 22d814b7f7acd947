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

template <bool soft>
bool GridSearch::run(Query& query) {
  const SearchGrid& grid = query.grid;
  const std::uint8_t* moves = grid.moves();
  const std::uint8_t* costs = grid.costs();
  const std::array<int, 8> offsets = grid.offsets();
  const int stride = grid.stride();
  const bool is_canonical = grid.has_every_move();
  std::uint32_t* cost_to_come = cost_to_come_.data();

  // Buckets an eighth of a step wide: narrow enough that order inside hardly matters.
  const int shift =
      std::max(0, static_cast<int>(std::bit_width(query.prices.scale().straight)) - 4);
  const std::size_t ring = std::bit_ceil((query.step_limit() >> shift) + std::size_t{2});
  if (buckets_.size() < ring) buckets_.resize(ring);
  for (auto& bucket : buckets_) bucket.clear();

  const maps::Cell start = grid.cell_of(query.start);
  std::size_t bucket = query.heuristic(start.x, start.y) >> shift;
  std::size_t waiting = 0;
  std::uint32_t best = kUnreached;  // cost of the goal once it is reached
  const std::uint32_t cost_limit = query.cost_limit();

  Entry next_entry{};  // the cell that is next in turn, when it need not wait in a bucket
  bool is_next = false;
  const auto expand = [&](std::uint32_t cell, std::uint32_t cost_here, int x, int y,
                          unsigned tried) {
    ++query.expanded;
    const std::uint8_t here = soft ? costs[cell] : std::uint8_t{0};
    for_each_move(tried, [&](std::size_t move) {
      const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      const std::uint32_t cost =
          cost_here + query.prices.step<soft>(move, here, soft ? costs[next] : std::uint8_t{0});
      const std::uint32_t old = cost_to_come[next];
      if (cost >= old) return;
      const std::uint32_t total = cost + query.heuristic(x + kMoves[move].dx, y + kMoves[move].dy);
      if (total >= best) return;
      if (old == kUnreached) touched_.push_back(next);
      cost_to_come[next] = cost;
      if (next == query.goal) {
        best = cost;
        return;
      }
      const std::size_t due = std::max<std::size_t>(total >> shift, bucket);
      auto& waits_in = buckets_[due & (ring - 1)];
      const Entry entry{next | static_cast<std::uint32_t>(move) << SearchGrid::kIndexBits, cost};
      if (due != bucket) {
        waits_in.push_back(entry);
        ++waiting;
        return;
      }
      if (is_next) {
        waits_in.push_back(next_entry);
        ++waiting;
      }
      next_entry = entry;
      is_next = true;
    });
  };
  cost_to_come[query.start] = 0;
  touched_.push_back(query.start);
  if (query.start == query.goal) return true;
  expand(query.start, 0, start.x, start.y, moves[query.start]);

  while (is_next || waiting > 0) {
    if (bucket > best >> shift) break;  // nothing left can improve on the goal's cost
    if (!is_next) {
      auto& open = buckets_[bucket & (ring - 1)];
      if (open.empty()) {
        ++bucket;
        continue;
      }
      next_entry = open.back();
      open.pop_back();
      --waiting;
    }
    const Entry entry = next_entry;
    is_next = false;
    const std::uint32_t cell = entry.cell_and_move & kIndexMask;
    if (entry.cost != cost_to_come[cell]) continue;  // improved since
    if (entry.cost > cost_limit) {
      query.overflow = true;
      return false;
    }
    const int row = static_cast<int>(cell) / stride;
    const int x = static_cast<int>(cell) - row * stride - 1;
    const int y = row - 1;
    // On open ground the goal shares its bucket with all cells of equally short ways.
    if (best != kUnreached && entry.cost + query.heuristic(x, y) >= best) continue;
    const bool pruned = is_canonical && (!soft || is_plain(costs + cell, stride));
    const MoveOrder& order = pruned ? kCanonicalMoves : kEveryMove;
    expand(cell, entry.cost, x, y,
           order(entry.cell_and_move >> SearchGrid::kIndexBits, moves[cell]));
  }
  return best != kUnreached;
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
  for (const auto& bucket : buckets_) bytes += bucket.capacity() * sizeof(Entry);
  return bytes + heap_.capacity() * sizeof(WeightedEntry) + expanded_.capacity() / 8;
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
