#include "planning/cost_to_go.h"

#include <bit>
#include <limits>

#include "planning/descent.h"
#include "planning/move_order.h"
#include "planning/step_prices.h"

namespace rovigo::planning {

void CostToGo::compute(const SearchGrid& grid, const std::vector<maps::Cell>& goals,
                       double soft_cost_weight) {
  grid_ = &grid;
  const bool soft = grid.costs() != nullptr && soft_cost_weight > 0.0;
  soft_cost_weight_ = soft ? soft_cost_weight : 0.0;
  // Soft costs are made of halves of steps, which the first scale does not have.
  for (std::size_t i = soft ? 1 : 0; i < kStepScales.size(); ++i) {
    scale_ = kStepScales[i];
    const StepPrices prices(scale_, soft_cost_weight_);
    if (soft ? flood<true>(prices, goals) : flood<false>(prices, goals)) return;
  }
}

/// Buckets no wider than the cheapest step: a cell's cost is final once its bucket is due, since
/// nothing in the bucket can improve it (Denardo & Fox 1979). So entries need no costs, and their
/// order inside a bucket does not matter.
template <bool soft>
bool CostToGo::flood(const StepPrices& prices, const std::vector<maps::Cell>& goals) {
  const SearchGrid& grid = *grid_;
  const std::uint8_t* moves = grid.moves();
  const std::uint8_t* soft_costs = grid.costs();
  const std::array<int, 8> offsets = grid.offsets();
  const bool is_canonical = grid.has_every_move();
  const int stride = grid.stride();
  costs_.assign(grid.padded_size(), kUnreached);
  std::uint32_t* costs = costs_.data();

  const int shift = std::bit_width(prices.scale().straight) - 1;
  const std::size_t ring = std::bit_ceil((prices.dearest_step() >> shift) + std::size_t{2});
  if (buckets_.size() < ring) buckets_.resize(ring);
  for (auto& bucket : buckets_) bucket.clear();
  const std::uint32_t cost_limit = kUnreached - prices.dearest_step();
  std::size_t waiting = 0;

  const auto expand = [&](std::uint32_t cell, unsigned tried, bool pruned) {
    const std::uint32_t cost_here = costs[cell];
    const std::uint8_t here = soft ? soft_costs[cell] : std::uint8_t{0};
    if (soft && !pruned) tried &= prices.improving_moves(costs + cell, soft_costs + cell, offsets);
    for_each_move(tried, [&](std::size_t move) {
      const auto next = static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[move]);
      const std::uint32_t cost =
          cost_here + prices.step<soft>(move, here, soft ? soft_costs[next] : std::uint8_t{0});
      const std::uint32_t old = costs[next];
      if (cost >= old) return;
      costs[next] = cost;
      // Which move led here matters to the order of moves only, where costs are none.
      if (soft && old >> shift == cost >> shift && soft_costs[next] != 0) return;
      buckets_[(cost >> shift) & (ring - 1)].push_back(next | static_cast<std::uint32_t>(move)
                                                                  << SearchGrid::kIndexBits);
      ++waiting;
    });
  };
  for (const maps::Cell goal : goals) {
    if (grid.is_passable(goal)) costs[grid.index_of(goal)] = 0;
  }
  for (const maps::Cell goal : goals) {
    if (grid.is_passable(goal)) expand(grid.index_of(goal), moves[grid.index_of(goal)], false);
  }
  constexpr std::uint32_t kIndexMask = (std::uint32_t{1} << SearchGrid::kIndexBits) - 1;
  for (std::uint32_t due = 0; waiting > 0; ++due) {
    auto& bucket = buckets_[due & (ring - 1)];  // nothing is added to it meanwhile
    waiting -= bucket.size();
    for (const std::uint32_t entry : bucket) {
      const std::uint32_t cell = entry & kIndexMask;
      if (costs[cell] >> shift != due) continue;  // improved since
      if (costs[cell] > cost_limit) return false;
      const bool pruned = is_canonical && (!soft || is_plain(soft_costs + cell, stride));
      const MoveOrder& order = pruned ? kCanonicalMoves : kEveryMove;
      expand(cell, order(entry >> SearchGrid::kIndexBits, moves[cell]), pruned);
    }
    bucket.clear();
  }
  return true;
}

double CostToGo::cost_m(maps::Cell cell) const {
  if (!grid_->is_passable(cell)) return std::numeric_limits<double>::infinity();
  const std::uint32_t cost = costs_[grid_->index_of(cell)];
  if (cost == kUnreached) return std::numeric_limits<double>::infinity();
  return static_cast<double>(cost) / scale_.straight * grid_->geometry().resolution_m;
}

CostToGo::Way CostToGo::way_from(maps::Cell cell) const {
  if (!grid_->is_passable(cell)) return {};
  const std::uint32_t from = grid_->index_of(cell);
  if (costs_[from] == kUnreached) return {};
  const StepPrices prices(scale_, soft_cost_weight_);
  Descent way = soft_cost_weight_ > 0.0 ? descend<true>(*grid_, costs_, prices, from)
                                        : descend<false>(*grid_, costs_, prices, from);
  return {std::move(way.cells), way.length_m};
}

std::size_t CostToGo::memory_bytes() const {
  std::size_t bytes = costs_.capacity() * sizeof(std::uint32_t);
  for (const auto& bucket : buckets_) bytes += bucket.capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace rovigo::planning
