#pragma once
// The way down a field of costs.

#include <cstdint>
#include <vector>

#include "planning/step_prices.h"

namespace rovigo::planning {

inline constexpr std::uint32_t kUnreached = 0xFFFFFFFFU;

struct Descent {
  std::vector<maps::Cell> cells;  ///< from where it began to where the cost is 0
  double length_m = 0.0;          ///< of the polyline through the cell centres
  std::uint32_t cost = 0;         ///< of the steps taken: the cost at `from`, or less
};

/// Costs of a search fall strictly towards where it began, so the way back needs no stored parents.
/// Among equals the move taken last is kept, which gives long straight runs. `costs` is indexed as
/// the grid is, kUnreached where nothing is known; it must be known at `from`.
template <bool soft>
Descent descend(const SearchGrid& grid, const std::vector<std::uint32_t>& costs,
                const StepPrices& prices, std::uint32_t from) {
  constexpr double kSqrt2 = 1.41421356237309504880;
  const std::array<int, 8> offsets = grid.offsets();
  const std::uint8_t* soft_costs = grid.costs();
  Descent out;
  std::uint32_t cell = from;
  maps::Cell at = grid.cell_of(cell);
  std::size_t last_move = 8, diagonal_steps = 0;
  out.cells.push_back(at);
  while (costs[cell] != 0) {
    std::size_t best_move = 8;
    std::uint32_t best = kUnreached;
    for (unsigned open = grid.moves()[cell]; open != 0; open &= open - 1) {
      const auto move = static_cast<std::size_t>(std::countr_zero(open));
      const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      if (costs[next] == kUnreached) continue;
      const std::uint32_t cost =
          costs[next] + prices.step<soft>(move, soft ? soft_costs[cell] : std::uint8_t{0},
                                          soft ? soft_costs[next] : std::uint8_t{0});
      if (cost < best || (cost == best && move == last_move)) {
        best = cost;
        best_move = move;
      }
    }
    last_move = best_move;
    out.cost += best - costs[static_cast<std::size_t>(static_cast<int>(cell) + offsets[best_move])];
    if (best_move >= kStraightMoves) ++diagonal_steps;
    cell = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[best_move]);
    at = {at.x + kMoves[best_move].dx, at.y + kMoves[best_move].dy};
    out.cells.push_back(at);
  }
  const std::size_t steps = out.cells.size() - 1;
  out.length_m = grid.geometry().resolution_m * (static_cast<double>(steps - diagonal_steps) +
                                                 kSqrt2 * static_cast<double>(diagonal_steps));
  return out;
}

}  // namespace rovigo::planning
