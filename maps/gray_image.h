#pragma once
// Grey images as map files carry them: PGM by our own reader, PNG through OpenCV.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "maps/occupancy_grid.h"

namespace rovigo::maps {

/// Row-major from the upper-left corner, as image files are.
struct GrayImage {
  int width = 0;
  int height = 0;
  int max_value = 255;                ///< white
  std::vector<std::uint16_t> pixels;  ///< 0 .. max_value; colours averaged
  std::vector<std::uint8_t>
      is_opaque;  ///< empty: all of it; else 0 where alpha is below its maximum
};

/// Decodes PGM (P2 or P5, comments, any maxval up to 65535) or PNG (grey, colour, palette, alpha, 8
/// or 16 bit). Throws InputError naming `name` for anything else, for truncated or damaged data,
/// and for more pixels than a grid may have.
GrayImage decode_gray_image(std::string_view bytes, const std::string& name);

/// Empty for a PNG that is whole (sizes within a grid's, every chunk there and its CRC right), else
/// what is wrong. To be asked before a PNG decoder, which prints, and takes whatever memory the
/// header claims.
std::string png_problem(std::string_view bytes);

/// A binary PGM of 8-bit pixels, rows from the top, with one comment line where `comment` is given.
std::string encode_pgm(int width, int height, const std::vector<std::uint8_t>& pixels,
                       const std::string& comment);

}  // namespace rovigo::maps
