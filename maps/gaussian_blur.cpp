#include "maps/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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
  const auto radius = static_cast<int>(std::floor(4.0 * sigma + 0.5));  // as SciPy rounds
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

/// Which stretches of kTile cells of each row hold anything: adding a zero changes no sum, so
/// empty stretches are passed over.
class TileMask {
 public:
  TileMask(const std::vector<std::uint8_t>& image, std::size_t width, std::size_t height)
      : tiles_((width + kTile - 1) / kTile), any_(tiles_ * height) {
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t t = 0; t < tiles_; ++t) {
        const auto row = image.begin() + static_cast<std::ptrdiff_t>(y * width);
        const auto begin = row + static_cast<std::ptrdiff_t>(t * kTile);
        const auto end = row + static_cast<std::ptrdiff_t>(std::min(width, (t + 1) * kTile));
        any_[y * tiles_ + t] = std::any_of(begin, end, [](std::uint8_t v) { return v != 0; });
      }
    }
  }
  std::size_t tiles() const { return tiles_; }
  bool any(std::size_t y, std::size_t tile) const { return any_[y * tiles_ + tile] != 0; }

 private:
  std::size_t tiles_;
  std::vector<std::uint8_t> any_;
};

/// One line with room on both sides for its reflection.
struct PaddedLine {
  PaddedLine(std::size_t width, std::size_t radius)
      : pad(radius), size(width), values(width + 2 * radius) {}
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

/// SciPy's order: the centre first, then pairs of neighbours from the farthest inwards.
void blur_across_rows(const std::vector<std::uint8_t>& image, const TileMask& mask,
                      std::size_t width, std::size_t height, std::size_t y,
                      const std::vector<double>& weights, PaddedLine& line) {
  const auto rows = static_cast<std::ptrdiff_t>(height);
  const auto at = static_cast<std::ptrdiff_t>(y);
  for (std::size_t t = 0; t < mask.tiles(); ++t) {
    const std::size_t begin = t * kTile;
    const std::size_t count = std::min(kTile, width - begin);
    double sums[kTile] = {};
    const std::uint8_t* centre = image.data() + y * width + begin;
    for (std::size_t x = 0; x < count; ++x) sums[x] = 100.0 * centre[x] * weights[0];
    bool any = mask.any(y, t);
    for (std::size_t j = weights.size() - 1; j > 0; --j) {
      const std::size_t below = reflected(at - static_cast<std::ptrdiff_t>(j), rows);
      const std::size_t above = reflected(at + static_cast<std::ptrdiff_t>(j), rows);
      if (!mask.any(below, t) && !mask.any(above, t)) continue;
      any = true;
      const std::uint8_t* a = image.data() + below * width + begin;
      const std::uint8_t* b = image.data() + above * width + begin;
      const double weight = weights[j];
      for (std::size_t x = 0; x < count; ++x) sums[x] += (100.0 * (a[x] + b[x])) * weight;
    }
    double* out = line.begin() + begin;
    if (!any) {
      std::fill(out, out + count, 0.0);
      continue;
    }
    for (std::size_t x = 0; x < count; ++x) out[x] = static_cast<int>(sums[x]);
  }
}

void blur_along_row(PaddedLine& line, const std::vector<double>& weights, std::uint8_t* out) {
  line.reflect();
  const double* in = line.begin();
  for (std::size_t begin = 0; begin < line.size; begin += kTile) {
    const std::size_t count = std::min(kTile, line.size - begin);
    const double* window = in + begin;
    const double* window_begin = window - line.pad;
    const double* window_end = window + count + line.pad;
    if (std::all_of(window_begin, window_end, [](double v) { return v == 0.0; })) {
      std::fill(out + begin, out + begin + count, std::uint8_t{0});
      continue;
    }
    double sums[kTile];
    for (std::size_t x = 0; x < count; ++x) sums[x] = window[x] * weights[0];
    for (std::size_t j = weights.size() - 1; j > 0; --j) {
      const double weight = weights[j];
      const double* left = window - j;
      const double* right = window + j;
      for (std::size_t x = 0; x < count; ++x) sums[x] += (left[x] + right[x]) * weight;
    }
    for (std::size_t x = 0; x < count; ++x) {
      out[begin + x] = static_cast<std::uint8_t>(static_cast<int>(sums[x]));
    }
  }
}

}  // namespace

std::vector<std::uint8_t> blur_like_scipy(const std::vector<std::uint8_t>& image, int width,
                                          int height, double sigma_cells) {
  std::vector<std::uint8_t> out(image.size());
  if (sigma_cells <= 1e-15) {  // SciPy's own threshold
    std::transform(image.begin(), image.end(), out.begin(),
                   [](std::uint8_t v) { return static_cast<std::uint8_t>(v ? 100 : 0); });
    return out;
  }
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  const std::vector<double> weights = kernel(sigma_cells);
  const TileMask mask(image, w, h);
  PaddedLine line(w, weights.size() - 1);
  for (std::size_t y = 0; y < h; ++y) {
    blur_across_rows(image, mask, w, h, y, weights, line);
    blur_along_row(line, weights, out.data() + y * w);
  }
  return out;
}

}  // namespace rovigo::maps
