#pragma once
// The first pass of SciPy's Gaussian blur: across the rows of an image of zeros and ones.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rovigo::maps {

constexpr std::size_t kBlurBlock = 16;  ///< cells that are worked on together

/// Sums are made in integers, sixteen cells at a time, and cut down to whole numbers. The rare sum
/// too near a whole number for that is done again in SciPy's own order of additions; so the values
/// are SciPy's, digit for digit. Rows within reach are kept aside: the image may be overwritten
/// line by line as it is blurred.
class ColumnBlur {
 public:
  /// `image`: row-major zeros and ones, not empty, to outlive this; `weights`: for distances
  /// 0 .. radius, summing up to 1 over both sides, to outlive this.
  ColumnBlur(const std::uint8_t* image, std::size_t width, std::size_t height,
             const std::vector<double>& weights);

  /// The least and the greatest value in a block.
  struct Range {
    std::uint8_t least;
    std::uint8_t greatest;
  };

  /// The next row, beginning with row 0: 100 times the blurred image, cut down. `values` and
  /// `ranges` have room for whole blocks and are what the call before left, but for the values
  /// beyond the width, which mean nothing.
  void next_row(float* values, Range* ranges);

 private:
  void set_weights();
  std::size_t slot(std::ptrdiff_t row) const;
  void keep(std::ptrdiff_t row);
  void slide_to_next_row();
  Range blur_block(std::size_t begin, float* values) const;
  int blur_exactly(std::size_t column) const;

  const std::uint8_t* image_;
  std::size_t width_;
  std::ptrdiff_t height_;
  const std::vector<double>& weights_;
  std::ptrdiff_t radius_;
  std::size_t blocks_;                     ///< in a row
  std::size_t slots_;                      ///< rows that are kept, as a ring
  std::vector<std::uint8_t> kept_;         ///< rows, padded to whole blocks with their last cell
  std::vector<std::uint8_t> kept_ones_;    ///< by slot and block: how many cells are 1
  std::vector<const std::uint8_t*> rows_;  ///< within reach of the row at hand, from the lowest
  std::vector<std::uint32_t> ones_;        ///< by block: how many cells of these rows are 1
  std::vector<std::uint16_t> high_;        ///< 100 times the weights in 2^-9 ...
  std::vector<std::uint16_t> low_;         ///< ... and what is left over in 2^-(9 + low_bits_)
  int low_bits_ = 0;
  int doubtful_ = 0;    ///< a sum nearer than this to a whole number is done exactly
  int solid_sum_ = 0;   ///< of a window of ones; -1: other windows have it, too
  std::uint8_t solid_;  ///< the value of a window of ones
  std::ptrdiff_t row_ = 0;
};

/// Index into 0 .. size-1 of a place beyond the border: d c b a | a b c d | d c b a.
std::size_t reflected(std::ptrdiff_t i, std::ptrdiff_t size);

/// What a window of nothing but `value` is blurred to.
std::uint8_t blur_uniform(double value, const std::vector<double>& weights);

}  // namespace rovigo::maps
