#pragma once
// Passable cells as bits, so that sixty-four of them are looked at in one step.

#include <bit>
#include <cstdint>
#include <vector>

namespace rovigo::planning {

/// Rows of bits with a closed border all around.
class BitRows {
 public:
  /// Where a straight run ends.
  struct Stop {
    int at = 0;
    bool passable = false;  ///< false: `at` is the first closed cell
  };

  BitRows(int length, int rows)
      : words_(static_cast<std::size_t>(length) / 64 + 3),
        bits_(words_ * (static_cast<std::size_t>(rows) + 2)) {}

  void open(int at, int row) {
    word(at, row) |= std::uint64_t{1} << (static_cast<unsigned>(at) & 63U);
  }
  bool is_open(int at, int row) const {
    const int shifted = at + 64;
    return (bits_[first_word(row) + static_cast<std::size_t>(shifted >> 6)] >>
                (static_cast<unsigned>(shifted) & 63U) &
            1U) != 0;
  }

  /// Runs from `at` upwards until the way is closed or a side opens: a neighbour row's cell that is
  /// open although the one before it is closed.
  Stop run_up(int at, int row) const {
    const std::uint64_t* mid = bits_.data() + first_word(row);
    const std::uint64_t* low = mid - words_;
    const std::uint64_t* high = mid + words_;
    const auto from = static_cast<unsigned>(at + 1 + 64);
    std::size_t w = from >> 6;
    for (std::uint64_t mask = ~std::uint64_t{0} << (from & 63U);; ++w, mask = ~std::uint64_t{0}) {
      const std::uint64_t opens = (low[w] & ~(low[w] << 1 | low[w - 1] >> 63)) |
                                  (high[w] & ~(high[w] << 1 | high[w - 1] >> 63));
      const std::uint64_t stop = (opens | ~mid[w]) & mask;
      if (stop == 0) continue;
      const int bit = std::countr_zero(stop);
      return {static_cast<int>(w * 64) + bit - 64, (mid[w] >> bit & 1U) != 0};
    }
  }
  /// The same downwards.
  Stop run_down(int at, int row) const {
    const std::uint64_t* mid = bits_.data() + first_word(row);
    const std::uint64_t* low = mid - words_;
    const std::uint64_t* high = mid + words_;
    const auto from = static_cast<unsigned>(at - 1 + 64);
    std::size_t w = from >> 6;
    for (std::uint64_t mask = ~std::uint64_t{0} >> (63U - (from & 63U));;
         --w, mask = ~std::uint64_t{0}) {
      const std::uint64_t opens = (low[w] & ~(low[w] >> 1 | low[w + 1] << 63)) |
                                  (high[w] & ~(high[w] >> 1 | high[w + 1] << 63));
      const std::uint64_t stop = (opens | ~mid[w]) & mask;
      if (stop == 0) continue;
      const int bit = 63 - std::countl_zero(stop);
      return {static_cast<int>(w * 64) + bit - 64, (mid[w] >> bit & 1U) != 0};
    }
  }

  std::size_t memory_bytes() const { return bits_.size() * sizeof(std::uint64_t); }

 private:
  std::size_t first_word(int row) const { return (static_cast<std::size_t>(row) + 1) * words_; }
  std::uint64_t& word(int at, int row) {
    return bits_[first_word(row) + static_cast<std::size_t>((at + 64) >> 6)];
  }

  std::size_t words_;  ///< of a row: a closed one on either side
  std::vector<std::uint64_t> bits_;
};

}  // namespace rovigo::planning
