#include "maps/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "maps/column_blur.h"
#include "maps/row_blur.h"

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

}  // namespace

int blur_radius_cells(double sigma_cells) {
  return static_cast<int>(std::floor(4.0 * sigma_cells + 0.5));
}

std::vector<double> blur_weights(double sigma_cells) {
  const int radius = blur_radius_cells(sigma_cells);
  std::vector<double> full;
  for (int x = -radius; x <= radius; ++x)
    full.push_back(std::exp(-0.5 / (sigma_cells * sigma_cells) * (x * x)));
  const double sum = numpy_sum(full.data(), full.size());
  std::vector<double> weights;
  for (auto i = static_cast<std::size_t>(radius); i < full.size(); ++i) {
    weights.push_back(full[i] / sum);
  }
  return weights;
}

std::vector<std::uint8_t> blur_like_scipy(std::vector<std::uint8_t> image, int width, int height,
                                          double sigma_cells, BlurOutput what) {
  if (image.empty()) return image;
  if (sigma_cells <= 1e-15) {  // SciPy's own threshold
    const std::uint8_t one = what == BlurOutput::kPositive ? 1 : 100;
    for (std::uint8_t& cell : image) cell = cell ? one : std::uint8_t{0};
    return image;
  }
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  const std::vector<double> weights = blur_weights(sigma_cells);
  ColumnBlur across(image.data(), w, h, weights);
  RowBlur along(w, weights, what);
  for (std::size_t y = 0; y < h; ++y) {
    across.next_row(along.values(), along.ranges());
    along.blur(image.data() + y * w);
  }
  return image;
}

}  // namespace rovigo::maps
