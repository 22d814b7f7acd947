#include "maps/gaussian_blur.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

// The inner loops are compiled for AVX2, too, and chosen at run time. Sums stay what they are:
// every lane adds in the same order, and the build forbids fused multiply-adds. This file includes
// no library whose types depend on the instruction set. Sanitizers cannot cope with the run-time
// choice, which happens before they start.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ROVIGO_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define ROVIGO_SIMD_CLONES
#endif

namespace rovigo::maps {
namespace {

/// NumPy's pairwise sum for fewer than 128 terms (longer arrays are halved): the order of additions
/// decides the last bit, and the last bit decides what is cut to which integer.
double numpy_sum(const double* terms, std::size_t count) {
  if (count < 8) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += terms[i];
    return sum;
  }
  if (count > 128) {
    const std::size_t half = count / 2 - count / 2 % 8;
    return numpy_sum(terms, half) + numpy_sum(terms + half, count - half);
  }
  double r[8];
  std::copy(terms, terms + 8, r);
  std::size_t i = 8;
  for (; i + 8 <= count; i += 8) {
    for (std::size_t k = 0; k < 8; ++k) r[k] += terms[i + k];
  }
  double sum = ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7]));
  for (; i < count; ++i) sum += terms[i];
  return sum;
}

/// Weights for distances 0 .. radius.
std::vector<double> kernel(double sigma) {
  const int radius = blur_radius_cells(sigma);
  std::vector<double> full;
  for (int x = -radius; x <= radius; ++x)
    full.push_back(std::exp(-0.5 / (sigma * sigma) * (x * x)));
  const double sum = numpy_sum(full.data(), full.size());
  std::vector<double> weights;
  for (auto i = static_cast<std::size_t>(radius); i < full.size(); ++i) {
    weights.push_back(full[i] / sum);
  }
  return weights;
}

/// Index into 0 .. size-1 of a place beyond the border.
std::size_t reflected(std::ptrdiff_t i, std::ptrdiff_t size) {
  const std::ptrdiff_t period = 2 * size;
  i = ((i % period) + period) % period;
  return static_cast<std::size_t>(i < size ? i : period - 1 - i);
}

constexpr std::size_t kTile = 64;
constexpr std::size_t kLanes = 16;  // sums held in registers at a time

/// sums += 100 (a + b) weight, over `count` zeros and ones.
ROVIGO_SIMD_CLONES void add_rows(const std::uint8_t* a, const std::uint8_t* b, double weight,
                                 std::size_t count, double* sums) {
  for (std::size_t x = 0; x < count; ++x) sums[x] += (100.0 * (a[x] + b[x])) * weight;
}

/// One tile along a row, in SciPy's order: the centre first, then pairs of neighbours from the
/// farthest inwards. Reads and writes whole tiles.
ROVIGO_SIMD_CLONES void correlate(const double* window, const double* weights, std::size_t radius,
                                  double* sums) {
  for (std::size_t begin = 0; begin < kTile; begin += kLanes) {
    const double* centre = window + begin;
    double sum[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) sum[k] = centre[k] * weights[0];
    for (std::size_t j = radius; j > 0; --j) {
      const double* left = centre - j;
      const double* right = centre + j;
      for (std::size_t k = 0; k < kLanes; ++k) sum[k] += (left[k] + right[k]) * weights[j];
    }
    for (std::size_t k = 0; k < kLanes; ++k) sums[begin + k] = sum[k];
  }
}

/// What a window of nothing but `value` is blurred to.
double blur_uniform(double value, const std::vector<double>& weights) {
  double sum = value * weights[0];
  for (std::size_t j = weights.size() - 1; j > 0; --j) sum += (value + value) * weights[j];
  return std::trunc(sum);
}

/// Which stretches of kTile cells of each row hold no obstacle, and which nothing else: most of a
/// map is one or the other, and needs no sums.
class TileMask {
 public:
  TileMask(const std::vector<std::uint8_t>& image, std::size_t width, std::size_t height)
      : tiles_((width + kTile - 1) / kTile), any_(tiles_ * height), all_(tiles_ * height) {
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t t = 0; t < tiles_; ++t) {
        const std::uint8_t* begin = image.data() + y * width + t * kTile;
        const std::size_t count = std::min(kTile, width - t * kTile);
        unsigned sum = 0;
        for (std::size_t x = 0; x < count; ++x) sum += begin[x];
        any_[y * tiles_ + t] = sum > 0;
        all_[y * tiles_ + t] = sum == count;
      }
    }
  }
  std::size_t tiles() const { return tiles_; }
  bool any(std::size_t y, std::size_t tile) const { return any_[y * tiles_ + tile] != 0; }
  bool all(std::size_t y, std::size_t tile) const { return all_[y * tiles_ + tile] != 0; }

 private:
  std::size_t tiles_;
  std::vector<std::uint8_t> any_;
  std::vector<std::uint8_t> all_;
};

/// One line with room on both sides for its reflection, and for whole tiles.
struct PaddedLine {
  PaddedLine(std::size_t width, std::size_t radius)
      : pad(radius), size(width), values(width + 2 * radius + kTile) {}
  double* begin() { return values.data() + pad; }
  void reflect() {
    const auto n = static_cast<std::ptrdiff_t>(size);
    for (std::ptrdiff_t i = 1; i <= static_cast<std::ptrdiff_t>(pad); ++i) {
      begin()[-i] = begin()[reflected(-i, n)];
      begin()[n - 1 + i] = begin()[reflected(n - 1 + i, n)];
    }
  }
  std::size_t pad;
  std::size_t size;
  std::vector<double> values;
};

/// The blur of one image, line by line: across the rows into a buffer, then along it.
class ScipyBlur {
 public:
  ScipyBlur(const std::vector<std::uint8_t>& image, std::size_t width, std::size_t height,
            std::vector<double> weights)
      : image_(image),
        width_(width),
        height_(height),
        weights_(std::move(weights)),
        mask_(image, width, height),
        line_(width, weights_.size() - 1),
        rows_(2 * weights_.size() - 1),
        tile_value_(mask_.tiles()) {
    for (std::size_t v = 0; v < uniform_.size(); ++v) {
      uniform_[v] = blur_uniform(static_cast<double>(v), weights_);
    }
  }

  void blur_row(std::size_t y, std::uint8_t* out) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i] = reflected(
          static_cast<std::ptrdiff_t>(y + i) - static_cast<std::ptrdiff_t>(weights_.size() - 1),
          static_cast<std::ptrdiff_t>(height_));
    }
    for (std::size_t t = 0; t < mask_.tiles(); ++t) blur_across(t);
    line_.reflect();
    for (std::size_t t = 0; t < mask_.tiles(); ++t) blur_along(t, out);
  }

 private:
  static constexpr double kMixed = -1.0;

  /// rows_[radius + j] and rows_[radius - j] are the rows j above and below.
  void blur_across(std::size_t tile) {
    const std::size_t begin = tile * kTile;
    const std::size_t count = std::min(kTile, width_ - begin);
    double* out = line_.begin() + begin;
    const auto is = [&](auto flag) { return std::all_of(rows_.begin(), rows_.end(), flag); };
    if (is([&](std::size_t row) { return !mask_.any(row, tile); })) {
      return fill(tile, out, count, 0.0);
    }
    if (is([&](std::size_t row) { return mask_.all(row, tile); })) {
      return fill(tile, out, count, uniform_[100]);
    }
    tile_value_[tile] = kMixed;
    const std::size_t radius = weights_.size() - 1;
    double sums[kTile];
    const std::uint8_t* centre = image_.data() + rows_[radius] * width_ + begin;
    for (std::size_t x = 0; x < count; ++x) sums[x] = 100.0 * centre[x] * weights_[0];
    for (std::size_t j = radius; j > 0; --j) {
      const std::size_t below = rows_[radius - j];
      const std::size_t above = rows_[radius + j];
      if (!mask_.any(below, tile) && !mask_.any(above, tile)) continue;  // adding 0 changes nothing
      add_rows(image_.data() + below * width_ + begin, image_.data() + above * width_ + begin,
               weights_[j], count, sums);
    }
    for (std::size_t x = 0; x < count; ++x) out[x] = static_cast<int>(sums[x]);
  }

  void fill(std::size_t tile, double* out, std::size_t count, double value) {
    std::fill(out, out + count, value);
    tile_value_[tile] = value;
  }

  void blur_along(std::size_t tile, std::uint8_t* out) {
    const std::size_t begin = tile * kTile;
    const std::size_t count = std::min(kTile, width_ - begin);
    const double* window = line_.begin() + begin;
    // What is reflected at the border comes from the tiles looked at, too.
    const std::size_t first = (begin - std::min(begin, line_.pad)) / kTile;
    const std::size_t last = std::min(begin + count + line_.pad, width_ - 1) / kTile;
    const double value = tile_value_[tile];
    if (value != kMixed && std::all_of(&tile_value_[first], &tile_value_[last] + 1,
                                       [value](double v) { return v == value; })) {
      const double blurred = uniform_[static_cast<std::size_t>(value)];
      std::fill(out + begin, out + begin + count, static_cast<std::uint8_t>(blurred));
      return;
    }
    double sums[kTile];
    correlate(window, weights_.data(), weights_.size() - 1, sums);
    for (std::size_t x = 0; x < count; ++x) {
      out[begin + x] = static_cast<std::uint8_t>(static_cast<int>(sums[x]));
    }
  }

  const std::vector<std::uint8_t>& image_;
  std::size_t width_;
  std::size_t height_;
  std::vector<double> weights_;
  TileMask mask_;
  PaddedLine line_;
  std::vector<std::size_t> rows_;
  std::vector<double> tile_value_;     ///< of the line, where a tile holds one value only
  std::array<double, 101> uniform_{};  ///< blur_uniform() of every value there is
};

}  // namespace

int blur_radius_cells(double sigma_cells) {
  return static_cast<int>(std::floor(4.0 * sigma_cells + 0.5));
}

std::vector<std::uint8_t> blur_like_scipy(const std::vector<std::uint8_t>& image, int width,
                                          int height, double sigma_cells) {
  std::vector<std::uint8_t> out(image.size());
  if (image.empty()) return out;
  if (sigma_cells <= 1e-15) {  // SciPy's own threshold
    std::transform(image.begin(), image.end(), out.begin(),
                   [](std::uint8_t v) { return static_cast<std::uint8_t>(v ? 100 : 0); });
    return out;
  }
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  ScipyBlur blur(image, w, h, kernel(sigma_cells));
  for (std::size_t y = 0; y < h; ++y) blur.blur_row(y, out.data() + y * w);
  return out;
}

}  // namespace rovigo::maps
