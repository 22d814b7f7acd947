#pragma once
// What a step of a search costs, in the integers of a StepScale.

#include <array>
#include <cmath>
#include <cstdint>

#include "maps/costmap.h"
#include "planning/search_grid.h"
#include "planning/step_scale.h"

namespace rovigo::planning {

/// A step costs its length times the mean of both cells' price, 1 + weight * soft cost / kMaxSoft.
class StepPrices {
 public:
  StepPrices(const StepScale& scale, double soft_cost_weight) : scale_(scale) {
    for (std::size_t c = 0; c < 256; ++c) {
      const double price =
          1.0 + soft_cost_weight * static_cast<double>(c) / maps::Costmap::kMaxSoft;
      half_straight_[c] = static_cast<std::uint32_t>(std::lround(0.5 * scale.straight * price));
      half_diagonal_[c] = static_cast<std::uint32_t>(std::lround(0.5 * scale.diagonal * price));
    }
  }

  const StepScale& scale() const { return scale_; }
  /// The cheapest step is scale().straight.
  std::uint32_t dearest_step() const { return 2 * half_diagonal_[255] + 1; }

  /// Of `move` between cells of these soft costs, which do not count unless `soft`.
  template <bool soft>
  std::uint32_t step(std::size_t move, std::uint8_t from, std::uint8_t to) const {
    if constexpr (soft) {
      const auto& half = move < kStraightMoves ? half_straight_ : half_diagonal_;
      return half[from] + half[to];
    } else {
      return move < kStraightMoves ? scale_.straight : scale_.diagonal;
    }
  }

  /// Of the eight moves from a cell, those that lead to lower costs than are known. Looks at all of
  /// them, open or not, which is quicker than to guess. `costs` and `soft_costs` begin at the cell.
  unsigned improving_moves(const std::uint32_t* costs, const std::uint8_t* soft_costs,
                           const std::array<int, 8>& offsets) const {
    unsigned moves = 0;
    const std::uint32_t straight = *costs + half_straight_[*soft_costs];
    const std::uint32_t diagonal = *costs + half_diagonal_[*soft_costs];
    for (std::size_t move = 0; move < kMoves.size(); ++move) {
      const std::uint8_t to = soft_costs[offsets[move]];
      const std::uint32_t reached =
          move < kStraightMoves ? straight + half_straight_[to] : diagonal + half_diagonal_[to];
      moves |= static_cast<unsigned>(reached < costs[offsets[move]]) << move;
    }
    return moves;
  }

 private:
  StepScale scale_;
  std::array<std::uint32_t, 256> half_straight_{};  ///< half the cost of a step, by soft cost
  std::array<std::uint32_t, 256> half_diagonal_{};
};

}  // namespace rovigo::planning
