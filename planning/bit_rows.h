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
        open_(words_ * (static_cast<std::size_t>(rows) + 2)) {}

  void open(int at, int row) { open_[word_of(at, row)] |= bit_of(at); }
  bool is_open(int at, int row) const { return (open_[word_of(at, row)] & bit_of(at)) != 0; }

  /// Call it once all cells are open that are to be.
  void find_stops() {
    stop_up_.assign(open_.size(), ~std::uint64_t{0});
    stop_down_ = stop_up_;
    for (std::size_t w = words_ + 1; w + words_ + 1 < open_.size(); ++w) {
      std::uint64_t up = ~open_[w], down = ~open_[w];
      for (const std::size_t side : {w - words_, w + words_}) {
        up |= open_[side] & ~(open_[side] << 1 | open_[side - 1] >> 63);
        down |= open_[side] & ~(open_[side] >> 1 | open_[side + 1] << 63);
      }
      stop_up_[w] = up;
      stop_down_[w] = down;
    }
  }

  /// From `at` (not included) upwards.
  Stop run_up(int at, int row) const {
    std::size_t w = word_of(at + 1, row);
    std::uint64_t stop = stop_up_[w] & ~std::uint64_t{0} << shift_of(at + 1);
    const std::size_t first = w;
    while (stop == 0) stop = stop_up_[++w];
    return stop_at(at + 1, w, first, std::countr_zero(stop));
  }
  /// The same downwards.
  Stop run_down(int at, int row) const {
    std::size_t w = word_of(at - 1, row);
    std::uint64_t stop = stop_down_[w] & ~std::uint64_t{0} >> (63U - shift_of(at - 1));
    const std::size_t first = w;
    while (stop == 0) stop = stop_down_[--w];
    return stop_at(at - 1, w, first, 63 - std::countl_zero(stop));
  }

  std::size_t memory_bytes() const { return 3 * open_.size() * sizeof(std::uint64_t); }

 private:
  static unsigned shift_of(int at) { return static_cast<unsigned>(at + 64) & 63U; }
  static std::uint64_t bit_of(int at) { return std::uint64_t{1} << shift_of(at); }
  std::size_t word_of(int at, int row) const {
    return (static_cast<std::size_t>(row) + 1) * words_ + static_cast<std::size_t>((at + 64) >> 6);
  }
  /// Bit `bit` of word `w`, where cell `at` lies in word `first`.
  Stop stop_at(int at, std::size_t w, std::size_t first, int bit) const {
    const int words = static_cast<int>(w) - static_cast<int>(first);
    return {at - static_cast<int>(shift_of(at)) + 64 * words + bit, (open_[w] >> bit & 1U) != 0};
  }

  std::size_t words_;  ///< of a row: a closed one on either side
  std::vector<std::uint64_t> open_, stop_up_, stop_down_;
};

}  // namespace rovigo::planning
