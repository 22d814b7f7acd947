#pragma once
// Passable cells as bits, so that sixty-four of them are looked at in one step.

#include <bit>
#include <cstdint>
#include <vector>

namespace rovigo::planning {

/// Rows of cells, closed all around, and where a straight run along a row ends: at the first closed
/// cell, or where a side opens (a neighbour row's cell that is open although the one before it is
/// closed).
class BitRows {
 public:
  struct Stop {
    int at = 0;
    bool passable = false;  ///< false: `at` is the first closed cell
  };

  /// All cells closed.
  BitRows(int length, int rows)
      : words_(static_cast<std::size_t>(length) / 64 + 3),
        cells_(words_ * (static_cast<std::size_t>(rows) + 2)) {}

  void open(int at, int row) { cells_[word_of(at, row)].open |= bit_of(at); }
  bool is_open(int at, int row) const { return (cells_[word_of(at, row)].open & bit_of(at)) != 0; }

  /// Call it once all cells are open that are to be.
  void find_stops() {
    for (std::size_t w = words_ + 1; w + words_ + 1 < cells_.size(); ++w) {
      std::uint64_t up = ~cells_[w].open, down = up;
      for (const std::size_t side : {w - words_, w + words_}) {
        const std::uint64_t open = cells_[side].open;
        up |= open & ~(open << 1 | cells_[side - 1].open >> 63);
        down |= open & ~(open >> 1 | cells_[side + 1].open << 63);
      }
      cells_[w].stop_up = up;
      cells_[w].stop_down = down;
    }
  }

  /// From `at` (not included) upwards.
  Stop run_up(int at, int row) const {
    std::size_t w = word_of(at + 1, row);
    std::uint64_t stop = cells_[w].stop_up & ~std::uint64_t{0} << shift_of(at + 1);
    const std::size_t first = w;
    while (stop == 0) stop = cells_[++w].stop_up;
    return stop_at(at + 1, w, first, std::countr_zero(stop));
  }
  /// The same downwards.
  Stop run_down(int at, int row) const {
    std::size_t w = word_of(at - 1, row);
    std::uint64_t stop = cells_[w].stop_down & ~std::uint64_t{0} >> (63U - shift_of(at - 1));
    const std::size_t first = w;
    while (stop == 0) stop = cells_[--w].stop_down;
    return stop_at(at - 1, w, first, 63 - std::countl_zero(stop));
  }

  std::size_t memory_bytes() const { return cells_.size() * sizeof(Cells); }

  /// For a look soon.
  void prefetch(int at, int row) const { __builtin_prefetch(cells_.data() + word_of(at, row)); }

 private:
  static unsigned shift_of(int at) { return static_cast<unsigned>(at + 64) & 63U; }
  static std::uint64_t bit_of(int at) { return std::uint64_t{1} << shift_of(at); }
  std::size_t word_of(int at, int row) const {
    return (static_cast<std::size_t>(row) + 1) * words_ + static_cast<std::size_t>((at + 64) >> 6);
  }
  /// Bit `bit` of word `w`, where cell `at` lies in word `first`.
  Stop stop_at(int at, std::size_t w, std::size_t first, int bit) const {
    const int words = static_cast<int>(w) - static_cast<int>(first);
    return {at - static_cast<int>(shift_of(at)) + 64 * words + bit,
            (cells_[w].open >> bit & 1U) != 0};
  }

  /// Sixty-four cells, side by side in memory because all are looked at together.
  struct alignas(32) Cells {
    std::uint64_t open = 0;
    std::uint64_t stop_up = ~std::uint64_t{0};
    std::uint64_t stop_down = ~std::uint64_t{0};
  };

  std::size_t words_;  ///< of a row: a closed one on either side
  std::vector<Cells> cells_;
};

}  // namespace rovigo::planning
