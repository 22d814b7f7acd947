#pragma once
// Passable cells as bits, so that sixty-four of them are looked at in one step.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace rovigo::planning {

/// Rows of cells, closed all around, and where a straight run along a row ends: at the first closed
/// cell, or where a side opens (a neighbour row's cell that is open although the one before it is
/// closed). What lies behind a word of cells is known beforehand, so that no run takes more than
/// two looks. Words of eight rows, one below the other, share a cache line, because a diagonal
/// looks along one row after the other.
class BitRows {
 public:
  struct Stop {
    int at = 0;
    bool passable = false;  ///< false: `at` is the first closed cell
  };

  /// All cells closed.
  BitRows(int length, int rows)
      : words_(static_cast<std::size_t>(length) / 64 + 3), rows_(static_cast<std::size_t>(rows)) {
    const std::size_t lines = words_ * ((rows_ + 2 + kRowsTogether - 1) / kRowsTogether);
    open_.resize(lines);
    for (Direction* direction : {&up_, &down_}) {
      direction->stops.resize(lines);
      direction->behind.resize(lines);
    }
  }

  void open(int at, int row) { open_[word_of(at, row)] |= bit_of(at); }
  bool is_open(int at, int row) const { return (open_[word_of(at, row)] & bit_of(at)) != 0; }

  /// Call it once all cells are open that are to be.
  void find_stops() {
    for (std::size_t row = 1; row <= rows_; ++row) {
      for (std::size_t column = 1; column + 1 < words_; ++column) find_stops(column, row);
      Stop stop{first_cell_of(words_ - 1)};
      for (std::size_t column = words_ - 2; column > 0; --column) {
        const std::size_t w = index_of(column, row);
        up_.behind[w] = stop;
        if (const auto bits = up_.stops[w]; bits != 0) {
          stop = stop_at(first_cell_of(column), w, std::countr_zero(bits));
        }
      }
      stop = {-1};
      for (std::size_t column = 1; column + 1 < words_; ++column) {
        const std::size_t w = index_of(column, row);
        down_.behind[w] = stop;
        if (const auto bits = down_.stops[w]; bits != 0) {
          stop = stop_at(first_cell_of(column), w, 63 - std::countl_zero(bits));
        }
      }
    }
  }

  /// From the open cell `at` (not included) upwards.
  Stop run_up(int at, int row) const {
    const std::size_t w = word_of(at, row);
    // Two shifts, because one by 64 is none.
    const auto stops = up_.stops[w] & ~std::uint64_t{0} << shift_of(at) << 1;
    if (stops == 0) return up_.behind[w];
    return stop_at(at - static_cast<int>(shift_of(at)), w, std::countr_zero(stops));
  }
  /// The same downwards.
  Stop run_down(int at, int row) const {
    const std::size_t w = word_of(at, row);
    const auto stops = down_.stops[w] & ~(~std::uint64_t{0} << shift_of(at));
    if (stops == 0) return down_.behind[w];
    return stop_at(at - static_cast<int>(shift_of(at)), w, 63 - std::countl_zero(stops));
  }

  std::size_t memory_bytes() const {
    return open_.memory_bytes() + up_.memory_bytes() + down_.memory_bytes();
  }

 private:
  static constexpr std::size_t kRowsTogether = 8;
  /// One value a word, eight of them aligned to a cache line.
  template <typename T>
  class OfWords {
   public:
    void resize(std::size_t lines) { lines_.resize(lines); }
    T& operator[](std::size_t w) { return lines_[w / kRowsTogether].rows[w % kRowsTogether]; }
    const T& operator[](std::size_t w) const {
      return lines_[w / kRowsTogether].rows[w % kRowsTogether];
    }
    std::size_t memory_bytes() const { return lines_.size() * sizeof(Line); }

   private:
    struct alignas(64) Line {
      std::array<T, kRowsTogether> rows{};
    };
    std::vector<Line> lines_;
  };

  struct Direction {
    OfWords<std::uint64_t> stops;
    OfWords<Stop> behind;  ///< the first stop behind the word
    std::size_t memory_bytes() const { return stops.memory_bytes() + behind.memory_bytes(); }
  };

  void find_stops(std::size_t column, std::size_t row) {
    const std::size_t w = index_of(column, row);
    std::uint64_t up = ~open_[w], down = up;
    for (const std::size_t side : {index_of(column, row - 1), index_of(column, row + 1)}) {
      const std::uint64_t open = open_[side];
      up |= open & ~(open << 1 | open_[side - kRowsTogether] >> 63);
      down |= open & ~(open >> 1 | open_[side + kRowsTogether] << 63);
    }
    up_.stops[w] = up;
    down_.stops[w] = down;
  }
  /// Bit `bit` of word `w`, which begins with cell `first`.
  Stop stop_at(int first, std::size_t w, int bit) const {
    return {first + bit, (open_[w] >> bit & 1U) != 0};
  }

  static unsigned shift_of(int at) { return static_cast<unsigned>(at) & 63U; }
  static std::uint64_t bit_of(int at) { return std::uint64_t{1} << shift_of(at); }
  static int first_cell_of(std::size_t column) { return (static_cast<int>(column) - 1) * 64; }
  /// Of the word in `column` of `row`; the first and last of each are closed.
  std::size_t index_of(std::size_t column, std::size_t row) const {
    return (row / kRowsTogether * words_ + column) * kRowsTogether + row % kRowsTogether;
  }
  std::size_t word_of(int at, int row) const {
    return index_of(static_cast<std::size_t>((at + 64) >> 6), static_cast<std::size_t>(row + 1));
  }

  std::size_t words_;  ///< of a row: a closed one on either side
  std::size_t rows_;   ///< without the closed ones
  OfWords<std::uint64_t> open_;
  Direction up_, down_;
};

}  // namespace rovigo::planning
