#pragma once
// Which moves are worth trying from a cell, when all ground costs the same.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "planning/search_grid.h"

namespace rovigo::planning {

/// Of several equally short ways to a cell, one that goes diagonally first is enough (Harabor &
/// Grastien 2011, in the form without corner cutting). What is left to try from a cell then follows
/// from the move that led to it: straight on, or round an obstacle's corner just passed.
/// Holds for eight neighbours, equal costs, and grids on which no move was closed by hand.
class MoveOrder {
 public:
  /// `canonical` false: every open move is tried.
  explicit constexpr MoveOrder(bool canonical) {
    for (std::size_t arrival = 0; arrival < 8; ++arrival) {
      for (unsigned open = 0; open < 256; ++open) {
        const unsigned tried = canonical ? canonical_moves(arrival, open) : 0xFFU;
        table_[arrival][open] = static_cast<std::uint8_t>(open & tried);
      }
    }
  }

  /// Bits of the moves to try from a cell with these `open` moves, reached by move `arrival`.
  std::uint8_t operator()(std::size_t arrival, std::uint8_t open) const {
    return table_[arrival][open];
  }

 private:
  static constexpr unsigned bit_of(int dx, int dy) {
    for (unsigned move = 0; move < 8; ++move) {
      if (kMoves[move].dx == dx && kMoves[move].dy == dy) return 1U << move;
    }
    return 0;
  }
  static constexpr unsigned canonical_moves(std::size_t arrival, unsigned open) {
    const int dx = kMoves[arrival].dx, dy = kMoves[arrival].dy;
    if (arrival >= kStraightMoves) return bit_of(dx, dy) | bit_of(dx, 0) | bit_of(0, dy);
    unsigned moves = bit_of(dx, dy);
    for (const int side : {1, -1}) {
      const int sx = dx == 0 ? side : 0, sy = dy == 0 ? side : 0;
      // The cell behind is open, so this says that the one beside it is closed.
      if ((open & bit_of(sx - dx, sy - dy)) == 0)
        moves |= bit_of(sx, sy) | bit_of(sx + dx, sy + dy);
    }
    return moves;
  }

  std::array<std::array<std::uint8_t, 256>, 8> table_{};
};

inline constexpr MoveOrder kEveryMove{false};
inline constexpr MoveOrder kCanonicalMoves{true};

/// Do this cell and its eight neighbours cost nothing extra? Then they are passable, too (others
/// have costs), and the canonical order holds there: the ways it leaves out have equals within
/// these nine cells. `soft_costs` begins at the cell and has four readable bytes a row.
inline bool is_plain(const std::uint8_t* soft_costs, int stride) {
  if (*soft_costs != 0) return false;
  std::uint32_t rows = 0;
  for (const int row : {-stride, 0, stride}) {
    std::uint32_t four = 0;
    std::memcpy(&four, soft_costs + row - 1, sizeof four);
    rows |= four;
  }
  return (rows & 0xFFFFFFU) == 0;  // the lowest three bytes on the machines this is built for
}

/// Calls `f(move)` for every bit set.
template <typename F>
void for_each_move(unsigned moves, F&& f) {
  for (; moves != 0; moves &= moves - 1) f(static_cast<std::size_t>(std::countr_zero(moves)));
}

}  // namespace rovigo::planning
