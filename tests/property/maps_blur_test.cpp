// The blur's shortcuts (integers, floats, blocks) against SciPy's additions written out, cell by
// cell in doubles, on random images of every kind of size and smoothing.

#include <gtest/gtest.h>

#include <random>

#include "maps/gaussian_blur.h"

namespace rovigo::maps {
namespace {

using Image = std::vector<std::uint8_t>;

int reflect(int i, int size) {
  while (i < 0 || i >= size) i = i < 0 ? -1 - i : 2 * size - 1 - i;
  return i;
}

/// One pass over `count` numbers `stride` apart, cut down to integers.
void pass(std::vector<int>& cells, int begin, int count, int stride,
          const std::vector<double>& weights) {
  const auto at = [&](int i) {
    return static_cast<double>(cells[static_cast<std::size_t>(begin + reflect(i, count) * stride)]);
  };
  std::vector<int> out;
  for (int i = 0; i < count; ++i) {
    double sum = at(i) * weights[0];
    for (int j = static_cast<int>(weights.size()) - 1; j > 0; --j) {
      sum += (at(i - j) + at(i + j)) * weights[static_cast<std::size_t>(j)];
    }
    out.push_back(static_cast<int>(sum));
  }
  for (int i = 0; i < count; ++i) {
    cells[static_cast<std::size_t>(begin + i * stride)] = out[static_cast<std::size_t>(i)];
  }
}

std::vector<int> written_out(const Image& image, int width, int height, double sigma) {
  std::vector<int> cells;
  for (const std::uint8_t cell : image) cells.push_back(100 * cell);
  const std::vector<double> weights = blur_weights(sigma);
  for (int x = 0; x < width; ++x) pass(cells, x, height, width, weights);
  for (int y = 0; y < height; ++y) pass(cells, y * width, width, 1, weights);
  return cells;
}

/// Noise, or a few rectangles with large solid insides, as maps have.
Image draw(int width, int height, std::mt19937& rng) {
  Image image(static_cast<std::size_t>(width * height));
  std::bernoulli_distribution noisy(0.5), obstacle(0.3);
  if (noisy(rng)) {
    for (std::uint8_t& cell : image) cell = obstacle(rng);
    return image;
  }
  std::uniform_int_distribution<int> column(0, width - 1), row(0, height - 1);
  for (int n = 0; n < 4; ++n) {
    int x0 = column(rng), x1 = column(rng), y0 = row(rng), y1 = row(rng);
    if (x0 > x1) std::swap(x0, x1);
    if (y0 > y1) std::swap(y0, y1);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) image[static_cast<std::size_t>(y * width + x)] = n != 3;
    }
  }
  return image;
}

TEST(BlurLikeScipy, EqualsItsAdditionsWrittenOutOnRandomImages) {
  std::mt19937 rng(2026);
  std::uniform_int_distribution<int> side(1, 90);
  std::uniform_real_distribution<double> logarithm(std::log(0.05), std::log(25.0));
  for (int trial = 0; trial < 150; ++trial) {
    const int width = side(rng), height = side(rng);
    const double sigma = trial % 3 == 0 ? 1 + trial / 3 % 4 : std::exp(logarithm(rng));
    const Image image = draw(width, height, rng);
    const std::vector<int> expected = written_out(image, width, height, sigma);
    const Image values = blur_like_scipy(image, width, height, sigma);
    const Image positive = blur_like_scipy(image, width, height, sigma, BlurOutput::kPositive);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(values[i], expected[i]) << width << " x " << height << ", sigma " << sigma;
      ASSERT_EQ(positive[i], expected[i] > 0) << width << " x " << height << ", sigma " << sigma;
    }
  }
}

}  // namespace
}  // namespace rovigo::maps
