#include "maps/column_blur.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "maps/simd_clones.h"

namespace rovigo::maps {
namespace {

constexpr int kHighBits = 9;  // of a sum of up to 100 in 16 bits, below the point

/// Sixteen numbers in a register or two.
using Sums [[gnu::vector_size(kBlurBlock * sizeof(std::uint16_t))]] = std::uint16_t;
using Cells [[gnu::vector_size(kBlurBlock)]] = std::uint8_t;

/// The weights of both sides, and where a sum of theirs is cut.
struct FixedWeights {
  const std::uint16_t* high;
  const std::uint16_t* low;
  std::size_t radius;
  int low_bits;
  int doubtful;
};

struct BlockSums {
  int sums[kBlurBlock];  ///< in 2^-(kHighBits + low_bits)
  int doubtful;          ///< how many are too near a whole number
  int least, greatest;   ///< cut down
};

/// A block's sums over the rows on both sides of its own; `rows` from the lowest of 2 radius + 1.
/// `values`: the sums cut down.
ROVIGO_SIMD_CLONES void add_rows(const std::uint8_t* const* rows, std::size_t begin,
                                 const FixedWeights& w, BlockSums& out, float* values) {
  Cells below, above;
  std::memcpy(&below, rows[w.radius] + begin, sizeof(Cells));
  Sums ones = __builtin_convertvector(below, Sums);
  Sums high_sum = ones * w.high[0];
  Sums low_sum = ones * w.low[0];
  for (std::size_t j = w.radius; j > 0; --j) {
    std::memcpy(&below, rows[w.radius - j] + begin, sizeof(Cells));
    std::memcpy(&above, rows[w.radius + j] + begin, sizeof(Cells));
    ones = __builtin_convertvector(below + above, Sums);
    high_sum += ones * w.high[j];
    low_sum += ones * w.low[j];
  }
  const int bits = kHighBits + w.low_bits;
  const int fraction = (1 << bits) - 1;
  int doubtful = 0, least = 255, greatest = 0;
  for (std::size_t x = 0; x < kBlurBlock; ++x) {
    const int sum = (high_sum[x] << w.low_bits) + low_sum[x];
    const int whole = sum >> bits;
    out.sums[x] = sum;
    values[x] = static_cast<float>(whole);
    doubtful += ((sum + w.doubtful) & fraction) < 2 * w.doubtful && sum != 0;
    least = whole < least ? whole : least;
    greatest = whole > greatest ? whole : greatest;
  }
  out.doubtful = doubtful;
  out.least = least;
  out.greatest = greatest;
}

}  // namespace

std::size_t reflected(std::ptrdiff_t i, std::ptrdiff_t size) {
  if (i >= 0 && i < size) return static_cast<std::size_t>(i);
  const std::ptrdiff_t period = 2 * size;
  i = ((i % period) + period) % period;
  return static_cast<std::size_t>(i < size ? i : period - 1 - i);
}

std::uint8_t blur_uniform(double value, const std::vector<double>& weights) {
  double sum = value * weights[0];
  for (std::size_t j = weights.size() - 1; j > 0; --j) sum += (value + value) * weights[j];
  return static_cast<std::uint8_t>(sum);
}

ColumnBlur::ColumnBlur(const std::uint8_t* image, std::size_t width, std::size_t height,
                       const std::vector<double>& weights)
    : image_(image),
      width_(width),
      height_(static_cast<std::ptrdiff_t>(height)),
      weights_(weights),
      radius_(static_cast<std::ptrdiff_t>(weights.size() - 1)),
      blocks_((width + kBlurBlock - 1) / kBlurBlock),
      slots_(std::min(height, 2 * weights.size() - 1)),
      kept_(slots_ * blocks_ * kBlurBlock),
      kept_ones_(slots_ * blocks_),
      rows_(2 * weights.size() - 1),
      ones_(blocks_),
      solid_(blur_uniform(100.0, weights)) {
  set_weights();
  for (std::ptrdiff_t y = 0; y < std::min(radius_, height_); ++y) keep(y);
  // Row 0's own window, but for its last row, which comes in exchange for the first one here.
  for (std::ptrdiff_t i = -radius_ - 1; i < radius_; ++i) {
    const std::uint8_t* ones = &kept_ones_[slot(i) * blocks_];
    for (std::size_t b = 0; b < blocks_; ++b) ones_[b] += ones[b];
  }
}

void ColumnBlur::set_weights() {
  const std::size_t terms = rows_.size();
  while (terms << (low_bits_ + 1) <= std::numeric_limits<std::uint16_t>::max()) ++low_bits_;
  bool all_count = true;
  for (const double weight : weights_) {
    const auto fixed =
        static_cast<int>(std::lround(std::ldexp(100.0 * weight, kHighBits + low_bits_)));
    high_.push_back(static_cast<std::uint16_t>(fixed >> low_bits_));
    low_.push_back(static_cast<std::uint16_t>(fixed & ((1 << low_bits_) - 1)));
    solid_sum_ += (high_.size() > 1 ? 2 : 1) * fixed;
    all_count = all_count && fixed > 0;
  }
  if (!all_count) solid_sum_ = -1;      // far cells may be missing and the sum the same
  doubtful_ = static_cast<int>(terms);  // twice what the weights' rounding adds up to
}

/// Where a row is kept; beyond the border the row that is reflected there.
std::size_t ColumnBlur::slot(std::ptrdiff_t row) const { return reflected(row, height_) % slots_; }

void ColumnBlur::keep(std::ptrdiff_t row) {
  const std::uint8_t* from = image_ + static_cast<std::size_t>(row) * width_;
  std::uint8_t* to = &kept_[slot(row) * blocks_ * kBlurBlock];
  std::memcpy(to, from, width_);
  std::fill(to + width_, to + blocks_ * kBlurBlock, to[width_ - 1]);
  std::uint8_t* ones = &kept_ones_[slot(row) * blocks_];
  for (std::size_t b = 0; b < blocks_; ++b, to += kBlurBlock) {
    unsigned sum = 0;
    for (std::size_t x = 0; x < kBlurBlock; ++x) sum += to[x];
    ones[b] = static_cast<std::uint8_t>(sum);
  }
}

void ColumnBlur::slide_to_next_row() {
  const std::uint8_t* leaving = &kept_ones_[slot(row_ - radius_ - 1) * blocks_];
  for (std::size_t b = 0; b < blocks_; ++b) ones_[b] -= leaving[b];
  if (row_ + radius_ < height_) keep(row_ + radius_);
  const std::uint8_t* entering = &kept_ones_[slot(row_ + radius_) * blocks_];
  for (std::size_t b = 0; b < blocks_; ++b) ones_[b] += entering[b];
  for (std::ptrdiff_t i = -radius_; i <= radius_; ++i) {
    rows_[static_cast<std::size_t>(i + radius_)] = &kept_[slot(row_ + i) * blocks_ * kBlurBlock];
  }
  ++row_;
}

void ColumnBlur::next_row(float* values, Range* ranges) {
  slide_to_next_row();
  const std::size_t full = rows_.size() * kBlurBlock;
  for (std::size_t b = 0; b < blocks_; ++b, values += kBlurBlock) {
    if (ones_[b] != 0 && ones_[b] != full) {
      ranges[b] = blur_block(b * kBlurBlock, values);
      continue;
    }
    const std::uint8_t value = ones_[b] == 0 ? std::uint8_t{0} : solid_;
    if (ranges[b].least == value && ranges[b].greatest == value) continue;  // as the row before
    std::fill(values, values + kBlurBlock, static_cast<float>(value));
    ranges[b] = {value, value};
  }
}

ColumnBlur::Range ColumnBlur::blur_block(std::size_t begin, float* values) const {
  const FixedWeights w{high_.data(), low_.data(), weights_.size() - 1, low_bits_, doubtful_};
  BlockSums block;
  add_rows(rows_.data(), begin, w, block, values);
  if (block.doubtful > 0) {
    const int fraction = (1 << (kHighBits + low_bits_)) - 1;
    for (std::size_t x = 0; x < kBlurBlock; ++x) {
      const int sum = block.sums[x];
      if (sum == 0 || ((sum + doubtful_) & fraction) >= 2 * doubtful_) continue;
      const int value = sum == solid_sum_ ? solid_ : blur_exactly(begin + x);
      values[x] = static_cast<float>(value);
      block.least = std::min(block.least, value);
      block.greatest = std::max(block.greatest, value);
    }
  }
  return {static_cast<std::uint8_t>(block.least), static_cast<std::uint8_t>(block.greatest)};
}

/// In SciPy's order: the centre first, then pairs of neighbours from the farthest inwards.
int ColumnBlur::blur_exactly(std::size_t column) const {
  const std::size_t radius = weights_.size() - 1;
  double sum = 100.0 * rows_[radius][column] * weights_[0];
  for (std::size_t j = radius; j > 0; --j) {
    sum += (100.0 * (rows_[radius - j][column] + rows_[radius + j][column])) * weights_[j];
  }
  return static_cast<int>(sum);
}

}  // namespace rovigo::maps
