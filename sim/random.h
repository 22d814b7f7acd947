#pragma once
// Counter-based random numbers: a value is a pure function of (seed, counter), so that neither the
// order of work nor the number of threads can change it.

#include <array>
#include <cstdint>

namespace rovigo::sim {

/// Scrambles 64 bits (the finaliser of SplitMix64, Steele et al. 2014).
inline std::uint64_t scramble(std::uint64_t x) {
  x ^= x >> 30U;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27U;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// A stream's seed from a parent seed and the stream's number.
inline std::uint64_t derive_seed(std::uint64_t seed, std::uint64_t stream) {
  return scramble(seed + 0x9e3779b97f4a7c15ULL * (stream + 1));
}

/// [0, 1) from 64 random bits.
inline double unit_interval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * (1.0 / 9007199254740992.0);
}

/// Quantiles of the standard normal distribution at (i + 1/2) / kSize, scaled to variance 1: twelve
/// random bits make one sample. Cut at about 3.7 sigma.
class GaussianTable {
 public:
  static constexpr std::size_t kSize = 4096;
  GaussianTable();
  float operator()(std::uint64_t bits) const { return values_[bits % kSize]; }

 private:
  std::array<float, kSize> values_;
};

/// A sequence of numbers from one stream.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : seed_(seed) {}
  std::uint64_t bits() { return derive_seed(seed_, counter_++); }
  double uniform(double low, double high) { return low + (high - low) * unit_interval(bits()); }
  /// Standard normal, by the polar method's trigonometric form (Box & Muller 1958).
  double gaussian();

 private:
  std::uint64_t seed_;
  std::uint64_t counter_ = 0;
};

}  // namespace rovigo::sim
