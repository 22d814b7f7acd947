#pragma once
// The second pass of SciPy's Gaussian blur: along a row of what ColumnBlur makes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "maps/column_blur.h"
#include "maps/gaussian_blur.h"

namespace rovigo::maps {

/// Sums are made in floats, sixteen at a time, and again in doubles, in SciPy's order, where a
/// float is too near a whole number to be cut down. They are spared where all numbers within reach
/// are the same and, when only positive values are asked for, where the cell's own share makes 1
/// already: adding what is not negative never takes a rounded sum back below.
class RowBlur {
 public:
  /// `weights`: for distances 0 .. radius, summing up to 1 over both sides, to outlive this.
  RowBlur(std::size_t width, const std::vector<double>& weights, BlurOutput what);

  /// Where ColumnBlur::next_row() writes.
  float* values() { return line_.data() + radius_; }
  ColumnBlur::Range* ranges() { return ranges_.data(); }

  /// Blurs these values into a row of the output.
  void blur(std::uint8_t* out);

 private:
  void reflect_borders();
  void blur_block(std::size_t begin, std::size_t count, std::uint8_t* out);
  ColumnBlur::Range within_reach(std::size_t begin, std::size_t end) const;
  void cut_down(const float* sums, const float* centre, std::size_t count, std::uint8_t* out) const;
  void cut_at_one(const float* sums, const float* centre, std::size_t count,
                  std::uint8_t* out) const;

  std::size_t width_;
  const std::vector<double>& weights_;
  std::vector<float> coarse_weights_;
  std::size_t radius_;
  float doubtful_;           ///< how far a sum in floats can be off
  std::vector<float> line_;  ///< with room on both sides for its reflection, and for whole blocks
  std::vector<ColumnBlur::Range> ranges_;
  std::array<std::uint8_t, 101> uniform_{};  ///< blur_uniform() of every value there is
  bool positive_;
  int certain_;  ///< a block of at least this is positive
};

}  // namespace rovigo::maps
