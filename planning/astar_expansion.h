#pragma once
// What A* does with a cell whose turn has come. Private to GridSearch (astar.h).

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "planning/astar.h"
#include "planning/descent.h"
#include "planning/move_order.h"
#include "planning/step_prices.h"

namespace rovigo::planning {

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
    constexpr double kHeuristicLimit = 3.0e9;  // leaves room for the cost in 32 bits
    const std::uint32_t h = prices.scale().octile(x - goal_x, y - goal_y);
    if (heuristic_weight == 1.0) return h;
    return static_cast<std::uint32_t>(std::min(h * heuristic_weight, kHeuristicLimit));
  }
  /// By how much a run may be ahead of its turn: waiting costs more than a few cells too many.
  std::uint32_t ahead_of_turn() const { return 8 * prices.scale().straight; }
  /// No cell's cost plus heuristic is above that of the cell whose turn led to it by more.
  std::uint32_t rise_limit() const {
    return prices.dearest_step() + ahead_of_turn() +
           static_cast<std::uint32_t>(prices.scale().diagonal * heuristic_weight);
  }
  /// Beyond this cost plus heuristic might not fit.
  std::uint32_t cost_limit() const {
    const auto& g = grid.geometry();
    return kUnreached - rise_limit() - heuristic(goal_x - g.width, goal_y - g.height);
  }
};

/// A cell on its turn, with what led there.
struct GridSearch::Visit {
  std::uint32_t cell;
  std::uint32_t cost;
  int x, y;
  std::size_t move;
};

/// Relaxes moves: lowers the costs of cells and lets these wait for their turn.
template <bool soft>
struct GridSearch::Expansion {
  Query& query;
  std::uint32_t* cost_to_come;
  std::vector<std::uint32_t>& touched;
  BucketQueue<Entry>& open;
  std::uint32_t best = kUnreached;  ///< cost of the goal once it is reached

  const StepPrices& prices = query.prices;
  const std::uint8_t* moves = query.grid.moves();
  const std::uint8_t* soft_costs = query.grid.costs();
  const std::array<int, 8> offsets = query.grid.offsets();
  const int stride = query.grid.stride();
  const bool is_canonical = query.grid.has_every_move();
  const std::uint32_t ahead_of_turn = query.ahead_of_turn();

  std::uint8_t soft_cost(std::uint32_t cell) const {
    return soft ? soft_costs[cell] : std::uint8_t{0};
  }
  std::uint32_t after(std::uint32_t cell, std::size_t move) const {
    return static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
  }
  bool may_prune(std::uint32_t cell) const {
    return is_canonical && (!soft || is_plain(soft_costs + cell, stride));
  }
  /// Does a straight move to this cell leave nothing to try but to go on?
  bool is_open_ground(std::uint32_t cell) const { return moves[cell] == 0xFF && may_prune(cell); }

  void expand(const Visit& at) {
    if (at.move < kStraightMoves && is_open_ground(at.cell)) {
      go_on(at);
    } else {
      const MoveOrder& order = may_prune(at.cell) ? kCanonicalMoves : kEveryMove;
      try_moves(at, order(at.move, moves[at.cell]));
    }
  }

  void try_moves(const Visit& at, unsigned tried) {
    ++query.expanded;
    for_each_move(tried, [&](std::size_t move) {
      const std::uint32_t next = after(at.cell, move);
      const std::uint32_t cost =
          at.cost + prices.step<soft>(move, soft_cost(at.cell), soft_cost(next));
      const std::uint32_t total =
          cost + query.heuristic(at.x + kMoves[move].dx, at.y + kMoves[move].dy);
      if (reach(next, cost, total)) wait(next, cost, total, move);
    });
  }

  /// Follows a run over open ground while it is due: most of all cells that are ever expanded.
  void go_on(Visit at) {
    const Move m = kMoves[at.move];
    if (!go_level(at)) return;
    for (;;) {
      ++query.expanded;
      at = {after(at.cell, at.move), at.cost + prices.scale().straight, at.x + m.dx, at.y + m.dy,
            at.move};
      const std::uint32_t total = at.cost + query.heuristic(at.x, at.y);
      if (!reach(at.cell, at.cost, total)) return;
      if (total > ahead_of_turn && !open.is_due(total - ahead_of_turn)) break;
      if (!is_open_ground(at.cell)) break;
    }
    wait(at.cell, at.cost, at.cost + query.heuristic(at.x, at.y), at.move);
  }

  /// The part of a run on which every step lowers the heuristic by what it costs: nothing changes
  /// but the cost. False where the run ended on it.
  bool go_level(Visit& at) {
    constexpr int kFetch = 8;  // cells to fetch memory ahead
    const Move m = kMoves[at.move];
    const int dx = query.goal_x - at.x, dy = query.goal_y - at.y;
    const int along = m.dx * dx + m.dy * dy, across = std::abs(m.dy * dx) + std::abs(m.dx * dy);
    const std::uint32_t first = at.cell;
    const int offset = offsets[at.move];
    int steps = 0;
    bool better = true, open_ground = true;
    // The last step is left to others: it may reach the goal.
    for (const int level = along - across - 1; steps < level && open_ground; ++steps) {
      const std::uint32_t next = after(at.cell, at.move);
      const std::uint32_t cost = at.cost + prices.scale().straight;
      better = cost < cost_to_come[next];
      if (!better) break;
      cost_to_come[next] = cost;
      at.cell = next;
      at.cost = cost;
      open_ground = is_open_ground(next);
      __builtin_prefetch(cost_to_come + static_cast<int>(next) + kFetch * offset, 1);
      __builtin_prefetch(moves + static_cast<int>(next) + kFetch * offset);
    }
    if (steps > 0) note_run(first, at.move, steps);
    at.x += steps * m.dx;
    at.y += steps * m.dy;
    query.expanded += static_cast<std::size_t>(steps);
    if (!better) {
      ++query.expanded;
    } else if (!open_ground) {
      wait(at.cell, at.cost, at.cost + query.heuristic(at.x, at.y), at.move);
    }
    return better && open_ground;
  }

  /// Notes a way to a cell. True when the cell must wait for its turn: this way is cheaper than
  /// what was known, may be part of the best way, and has not arrived.
  bool reach(std::uint32_t cell, std::uint32_t cost, std::uint32_t total) {
    const std::uint32_t old = cost_to_come[cell];
    if (cost >= old || total >= best) return false;
    if (old == kUnreached) touched.push_back(cell);
    cost_to_come[cell] = cost;
    if (cell == query.goal) best = cost;
    return cell != query.goal;
  }

  void wait(std::uint32_t cell, std::uint32_t cost, std::uint32_t total, std::size_t move) {
    open.push(total, {cell | static_cast<std::uint32_t>(move) << SearchGrid::kIndexBits, cost});
  }

  /// Cells to clear before the next query: the `steps` behind the first one.
  void note_run(std::uint32_t first, std::size_t move, int steps) {
    touched.push_back(first | static_cast<std::uint32_t>(move + 1) << SearchGrid::kIndexBits);
    touched.push_back(static_cast<std::uint32_t>(steps));
  }
};

}  // namespace rovigo::planning
