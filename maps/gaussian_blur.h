#pragma once
// SciPy's Gaussian blur of an integer image, for the reference inflation.

#include <cstdint>
#include <vector>

namespace rovigo::maps {

enum class BlurOutput {
  kValues,    ///< 0 .. 100
  kPositive,  ///< 1 where the value is above 0: all that the inflation asks for, and faster
};

/// What scipy.ndimage.gaussian_filter(100 * image.astype(int64), sigma) returns for an image of
/// zeros and ones, digit for digit: rows first, then columns; after each pass the doubles are cut
/// down to integers; beyond the border the image is reflected (d c b a | a b c d | d c b a); the
/// kernel reaches int(4 sigma + 0.5) cells. Row-major, `width` x `height`; values 0 .. 100.
/// Sigma 0 means no blur.
std::vector<std::uint8_t> blur_like_scipy(std::vector<std::uint8_t> image, int width, int height,
                                          double sigma_cells,
                                          BlurOutput what = BlurOutput::kValues);

/// The weights at distances 0 .. blur_radius_cells(), SciPy's to the last bit.
std::vector<double> blur_weights(double sigma_cells);

/// How far the kernel reaches, as SciPy rounds it.
int blur_radius_cells(double sigma_cells);

}  // namespace rovigo::maps
