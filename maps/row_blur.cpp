#include "maps/row_blur.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "maps/simd_clones.h"

namespace rovigo::maps {
namespace {

/// Eight neighbours in a register: left to itself, the compiler turns the loops below about.
using Eight [[gnu::vector_size(8 * sizeof(float))]] = float;
static_assert(kBlurBlock * sizeof(float) == 2 * sizeof(Eight));

/// One block along a row, nearly: within doubtful() of what SciPy adds up in doubles.
ROVIGO_SIMD_CLONES void correlate(const float* centre, const float* weights, std::size_t radius,
                                  float* sums) {
  Eight low, high, left, right;
  std::memcpy(&low, centre, sizeof(Eight));
  std::memcpy(&high, centre + 8, sizeof(Eight));
  low *= weights[0];
  high *= weights[0];
  for (std::size_t j = radius; j > 0; --j) {
    std::memcpy(&left, centre - j, sizeof(Eight));
    std::memcpy(&right, centre + j, sizeof(Eight));
    low += (left + right) * weights[j];
    std::memcpy(&left, centre + 8 - j, sizeof(Eight));
    std::memcpy(&right, centre + 8 + j, sizeof(Eight));
    high += (left + right) * weights[j];
  }
  std::memcpy(sums, &low, sizeof(Eight));
  std::memcpy(sums + 8, &high, sizeof(Eight));
}

/// Which sums are 1 or more; returns how many are too near to say.
ROVIGO_SIMD_CLONES int compare_with_one(const float* sums, float doubtful, std::uint8_t* positive) {
  int count = 0;
  for (std::size_t x = 0; x < kBlurBlock; ++x) {
    positive[x] = sums[x] >= 1.0F;
    count += std::abs(sums[x] - 1.0F) < doubtful;
  }
  return count;
}

/// One cell in SciPy's order: the centre first, then pairs of neighbours from the farthest inwards.
double correlate_exactly(const float* centre, const std::vector<double>& weights) {
  double sum = static_cast<double>(*centre) * weights[0];
  for (std::size_t j = weights.size() - 1; j > 0; --j) {
    sum += (static_cast<double>(centre[-static_cast<std::ptrdiff_t>(j)]) + centre[j]) * weights[j];
  }
  return sum;
}

/// How far a sum of up to 100 in floats can be off: half a unit in the last place of each weight
/// and each addition, and as much again.
float doubtful(std::size_t radius) {
  return 100.0F * static_cast<float>(radius + 4) * std::numeric_limits<float>::epsilon();
}

}  // namespace

RowBlur::RowBlur(std::size_t width, const std::vector<double>& weights, BlurOutput what)
    : width_(width),
      weights_(weights),
      coarse_weights_(weights.begin(), weights.end()),
      radius_(weights.size() - 1),
      doubtful_(doubtful(radius_)),
      line_(width + 2 * radius_ + kBlurBlock),
      ranges_((width + kBlurBlock - 1) / kBlurBlock, {255, 0}),
      positive_(what == BlurOutput::kPositive),
      certain_(positive_ ? static_cast<int>(std::ceil(1.0 / weights[0] + 1e-9)) : 256) {
  for (std::size_t v = 0; v < uniform_.size(); ++v) {
    const std::uint8_t value = blur_uniform(static_cast<double>(v), weights);
    uniform_[v] = positive_ ? std::uint8_t{value > 0} : value;
  }
}

void RowBlur::blur(std::uint8_t* out) {
  reflect_borders();
  for (std::size_t begin = 0; begin < width_; begin += kBlurBlock) {
    blur_block(begin, std::min(kBlurBlock, width_ - begin), out + begin);
  }
}

void RowBlur::reflect_borders() {
  const auto size = static_cast<std::ptrdiff_t>(width_);
  for (std::ptrdiff_t i = 1; i <= static_cast<std::ptrdiff_t>(radius_); ++i) {
    values()[-i] = values()[reflected(-i, size)];
    values()[size - 1 + i] = values()[reflected(size - 1 + i, size)];
  }
}

void RowBlur::blur_block(std::size_t begin, std::size_t count, std::uint8_t* out) {
  if (ranges_[begin / kBlurBlock].least >= certain_) {
    std::fill(out, out + count, std::uint8_t{1});
    return;
  }
  const ColumnBlur::Range range = within_reach(begin, begin + count);
  if (range.least == range.greatest) {
    std::fill(out, out + count, uniform_[range.least]);
    return;
  }
  const float* centre = values() + begin;
  float sums[kBlurBlock];
  correlate(centre, coarse_weights_.data(), radius_, sums);
  if (positive_) {
    cut_at_one(sums, centre, count, out);
  } else {
    cut_down(sums, centre, count, out);
  }
}

/// What is reflected at the border comes from the blocks looked at, too.
ColumnBlur::Range RowBlur::within_reach(std::size_t begin, std::size_t end) const {
  const std::size_t first = (begin - std::min(begin, radius_)) / kBlurBlock;
  const std::size_t last = std::min(end + radius_, width_ - 1) / kBlurBlock;
  ColumnBlur::Range range = ranges_[first];
  for (std::size_t b = first + 1; b <= last; ++b) {
    range.least = std::min(range.least, ranges_[b].least);
    range.greatest = std::max(range.greatest, ranges_[b].greatest);
  }
  return range;
}

void RowBlur::cut_down(const float* sums, const float* centre, std::size_t count,
                       std::uint8_t* out) const {
  for (std::size_t x = 0; x < count; ++x) {
    const bool sure = std::abs(sums[x] - std::nearbyint(sums[x])) >= doubtful_;
    out[x] = static_cast<std::uint8_t>(sure ? sums[x] : correlate_exactly(centre + x, weights_));
  }
}

void RowBlur::cut_at_one(const float* sums, const float* centre, std::size_t count,
                         std::uint8_t* out) const {
  std::uint8_t positive[kBlurBlock];
  if (compare_with_one(sums, doubtful_, positive) > 0) {
    for (std::size_t x = 0; x < count; ++x) {
      if (std::abs(sums[x] - 1.0F) >= doubtful_) continue;
      positive[x] = correlate_exactly(centre + x, weights_) >= 1.0;
    }
  }
  std::memcpy(out, positive, count);
}

}  // namespace rovigo::maps
