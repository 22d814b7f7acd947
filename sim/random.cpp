#include "sim/random.h"

#include <cmath>

#include "maps/geometry.h"

namespace rovigo::sim {
namespace {

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

double normal_quantile(double p) {
  double low = -8.0;
  double high = 8.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

GaussianTable::GaussianTable() {
  std::array<double, kSize> exact;
  double sum_of_squares = 0.0;
  for (std::size_t i = 0; i < kSize; ++i) {
    exact[i] = normal_quantile((static_cast<double>(i) + 0.5) / kSize);
    sum_of_squares += exact[i] * exact[i];
  }
  const double scale = 1.0 / std::sqrt(sum_of_squares / kSize);
  for (std::size_t i = 0; i < kSize; ++i) values_[i] = static_cast<float>(exact[i] * scale);
}

double RandomStream::gaussian() {
  const double u = 1.0 - uniform(0.0, 1.0);  // (0, 1], so that the logarithm is finite
  const double v = uniform(0.0, 1.0);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * maps::kPi * v);
}

}  // namespace rovigo::sim
