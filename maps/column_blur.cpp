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

/// What the rows on both sides of a block's own add up to; `rows` from the lowest of 2 radius + 1.
ROVIGO_SIMD_CLONES void add_rows(const std::uint8_t* const* rows, std::size_t begin,
                                 std::size_t radius, const std::uint16_t* high,
                                 const std::uint16_t* low, int low_bits, int* sums) {
  Cells below, above;
  std::memcpy(&below, rows[radius] + begin, sizeof(Cells));
  Sums ones = __builtin_convertvector(below, Sums);
  Sums high_sum = ones * high[0];
  Sums low_sum = ones * low[0];
  for (std::size_t j = radius; j > 0; --j) {
    std::memcpy(&below, rows[radius - j] + begin, sizeof(Cells));
    std::memcpy(&above, rows[radius + j] + begin, sizeof(Cells));
    ones = __builtin_convertvector(below + above, Sums);
    high_sum += ones * high[j];
    low_sum += ones * low[j];
  }
  for (std::size_t x = 0; x < kBlurBlock; ++x) sums[x] = (high_sum[x] << low_bits) + low_sum[x];
}

/// Cuts sums of so many bits below the point down to whole numbers; how many are doubtful.
ROVIGO_SIMD_CLONES int cut_down(const int* sums, int bits, int doubtful, int* whole) {
  const int fraction = (1 << bits) - 1;
  int count = 0;
  for (std::size_t x = 0; x < kBlurBlock; ++x) {
    whole[x] = sums[x] >> bits;
    count += ((sums[x] + doubtful) & fraction) < 2 * doubtful && sums[x] != 0;
  }
  return count;
}

/// To floats; the least and the greatest.
ROVIGO_SIMD_CLONES void convert(const int* whole, float* values, int& least, int& greatest) {
  int lowest = whole[0], highest = whole[0];
  for (std::size_t x = 0; x < kBlurBlock; ++x) {
    values[x] = static_cast<float>(whole[x]);
    lowest = whole[x] < lowest ? whole[x] : lowest;
    highest = whole[x] > highest ? whole[x] : highest;
  }
  least = lowest;
  greatest = highest;
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
  const int bits = kHighBits + low_bits_;
  int sums[kBlurBlock], whole[kBlurBlock];
  add_rows(rows_.data(), begin, weights_.size() - 1, high_.data(), low_.data(), low_bits_, sums);
  if (cut_down(sums, bits, doubtful_, whole) > 0) {
    for (std::size_t x = 0; x < kBlurBlock; ++x) {
      const int fraction = (sums[x] + doubtful_) & ((1 << bits) - 1);
      if (sums[x] == 0 || fraction >= 2 * doubtful_) continue;
      whole[x] = sums[x] == solid_sum_ ? solid_ : blur_exactly(begin + x);
    }
  }
  int least = 0, greatest = 0;
  convert(whole, values, least, greatest);
  return {static_cast<std::uint8_t>(least), static_cast<std::uint8_t>(greatest)};
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
