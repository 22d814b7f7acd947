#include "planning/astar.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "planning/step_scale.h"

namespace rovigo::planning {

namespace {

constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();
constexpr double kHeuristicLimit = 3.0e9;  // leaves room for the cost in 32 bits
constexpr double kSqrt2 = 1.41421356237309504880;

}  // namespace

/// One search: what does not change while it runs, and what it counts.
struct GridSearch::Query {
  const SearchGrid* grid = nullptr;
  std::uint32_t start = 0;
  std::uint32_t goal = 0;
  int goal_x = 0;  // in padded columns and rows
  int goal_y = 0;
  StepScale scale{};
  double heuristic_weight = 1.0;
  std::array<std::uint32_t, 256> half_straight{};  // half the cost of a step, by soft cost
  std::array<std::uint32_t, 256> half_diagonal{};
  std::uint32_t step_limit = 0;  // no single step raises cost plus heuristic by more
  std::size_t expanded = 0;
  bool overflow = false;

  std::uint32_t heuristic(int x, int y) const {
    const std::uint32_t h = scale.octile(x - goal_x, y - goal_y);
    if (heuristic_weight == 1.0) return h;
    return static_cast<std::uint32_t>(std::min(h * heuristic_weight, kHeuristicLimit));
  }
  template <bool soft>
  std::uint32_t step_cost(std::size_t move, std::uint8_t from, std::uint8_t to) const {
    if constexpr (soft) {
      const auto& half = move < kStraightMoves ? half_straight : half_diagonal;
      return half[from] + half[to];
    } else {
      return move < kStraightMoves ? scale.straight : scale.diagonal;
    }
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
    const StepScale& scale = kStepScales[attempt];
    Query query;
    query.grid = &grid;
    query.start = grid.index_of(start);
    query.goal = grid.index_of(goal);
    query.goal_x = goal.x;
    query.goal_y = goal.y;
    query.scale = scale;
    query.heuristic_weight = std::max(1.0, weights.heuristic);
    const double weight = soft ? weights.soft_cost : 0.0;
    for (std::size_t c = 0; c < 256; ++c) {
      const double price = 1.0 + weight * static_cast<double>(c) / maps::Costmap::kMaxSoft;
      query.half_straight[c] =
          static_cast<std::uint32_t>(std::lround(0.5 * scale.straight * price));
      query.half_diagonal[c] =
          static_cast<std::uint32_t>(std::lround(0.5 * scale.diagonal * price));
    }
    query.step_limit = 2 * query.half_diagonal[255] +
                       static_cast<std::uint32_t>(scale.diagonal * query.heuristic_weight) + 1;
    prepare(grid);
    result.found = soft ? run<true>(query) : run<false>(query);
    result.expanded_cells = query.expanded;
    if (query.overflow) continue;
    if (!result.found) return result;
    result.cost_m = static_cast<double>(cost_to_come_[query.goal]) / scale.straight *
                    grid.geometry().resolution_m;
    soft ? collect_path<true>(query, result) : collect_path<false>(query, result);
    return result;
  }
  result.found = false;
  return result;
}

template <bool soft>
bool GridSearch::run(Query& query) {
  const SearchGrid& grid = *query.grid;
  const std::uint8_t* moves = grid.moves();
  const std::uint8_t* costs = grid.costs();
  const std::array<int, 8> offsets = grid.offsets();
  const int stride = grid.stride();
  std::uint32_t* cost_to_come = cost_to_come_.data();

  // Buckets an eighth of a step wide: narrow enough that order inside hardly matters.
  const int shift = std::max(0, static_cast<int>(std::bit_width(query.scale.straight)) - 4);
  const std::size_t ring = std::bit_ceil((query.step_limit >> shift) + std::size_t{2});
  if (buckets_.size() < ring) buckets_.resize(ring);
  for (auto& bucket : buckets_) bucket.clear();

  const maps::Cell start = grid.cell_of(query.start);
  std::size_t bucket = query.heuristic(start.x, start.y) >> shift;
  std::size_t waiting = 1;
  std::uint32_t best = kUnreached;  // cost of the goal once it is reached
  const std::uint32_t cost_limit =
      kUnreached - query.step_limit -
      static_cast<std::uint32_t>(std::min(
          kHeuristicLimit, query.heuristic_weight *
                               query.scale.octile(grid.geometry().width, grid.geometry().height)));
  cost_to_come[query.start] = 0;
  touched_.push_back(query.start);
  if (query.start == query.goal) return true;
  buckets_[bucket & (ring - 1)].push_back({query.start, 0});

  while (waiting > 0) {
    auto& open = buckets_[bucket & (ring - 1)];
    if (open.empty()) {
      ++bucket;
      continue;
    }
    if (bucket > best >> shift) break;  // nothing left can improve on the goal's cost
    const Entry entry = open.back();
    open.pop_back();
    --waiting;
    if (entry.cost != cost_to_come[entry.cell]) continue;  // improved since
    if (entry.cell == query.goal) continue;
    if (entry.cost > cost_limit) {
      query.overflow = true;
      return false;
    }
    const int row = static_cast<int>(entry.cell) / stride;
    const int x = static_cast<int>(entry.cell) - row * stride - 1;
    const int y = row - 1;
    // On open ground the goal shares its bucket with all cells of equally short ways.
    if (best != kUnreached && entry.cost + query.heuristic(x, y) >= best) continue;
    ++query.expanded;
    const std::uint8_t here = soft ? costs[entry.cell] : std::uint8_t{0};
    for (unsigned open_moves = moves[entry.cell]; open_moves != 0; open_moves &= open_moves - 1) {
      const auto move = static_cast<std::size_t>(std::countr_zero(open_moves));
      const auto next = static_cast<std::uint32_t>(static_cast<int>(entry.cell) + offsets[move]);
      const std::uint32_t cost =
          entry.cost + query.step_cost<soft>(move, here, soft ? costs[next] : std::uint8_t{0});
      const std::uint32_t old = cost_to_come[next];
      if (cost >= old) continue;
      const std::uint32_t total = cost + query.heuristic(x + kMoves[move].dx, y + kMoves[move].dy);
      if (total >= best) continue;
      if (old == kUnreached) touched_.push_back(next);
      cost_to_come[next] = cost;
      if (next == query.goal) best = cost;
      // A weighted heuristic may let the total fall; such a cell is due at once.
      const std::size_t due = std::max<std::size_t>(total >> shift, bucket);
      buckets_[due & (ring - 1)].push_back({next, cost});
      ++waiting;
    }
  }
  return best != kUnreached;
}

template <bool soft>
void GridSearch::collect_path(const Query& query, GridSearchResult& result) const {
  // Costs fall strictly towards the start, so the way back needs no stored parents. Among equals
  // the move taken last is kept, which gives long straight runs.
  const SearchGrid& grid = *query.grid;
  const std::array<int, 8> offsets = grid.offsets();
  const std::uint8_t* costs = grid.costs();
  std::uint32_t cell = query.goal;
  std::size_t last_move = 8;
  std::size_t diagonal_steps = 0;
  result.cells.push_back(grid.cell_of(cell));
  while (cell != query.start) {
    std::size_t best_move = 8;
    std::uint32_t best = kUnreached;
    for (unsigned open_moves = grid.moves()[cell]; open_moves != 0; open_moves &= open_moves - 1) {
      const auto move = static_cast<std::size_t>(std::countr_zero(open_moves));
      const auto from = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      if (cost_to_come_[from] == kUnreached) continue;
      const std::uint32_t cost =
          cost_to_come_[from] + query.step_cost<soft>(move, soft ? costs[cell] : std::uint8_t{0},
                                                      soft ? costs[from] : std::uint8_t{0});
      if (cost < best || (cost == best && move == last_move)) {
        best = cost;
        best_move = move;
      }
    }
    last_move = best_move;
    if (best_move >= kStraightMoves) ++diagonal_steps;
    cell = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[best_move]);
    result.cells.push_back(grid.cell_of(cell));
  }
  std::reverse(result.cells.begin(), result.cells.end());
  const std::size_t steps = result.cells.size() - 1;
  result.length_m = grid.geometry().resolution_m * (static_cast<double>(steps - diagonal_steps) +
                                                    kSqrt2 * static_cast<double>(diagonal_steps));
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
