#pragma once
// ROS 1 image messages as the images the other readers hand out.

#include <mrpt/math/CMatrixDynamic.h>

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "slam/recording/bag_messages.h"

namespace rovigo::slam {

/// What an image topic can serve as, by the encoding of its first image.
enum class BagImageKind { kColor, kGrey, kDepth, kOther };
BagImageKind kind_of_encoding(std::string_view encoding);

/// 8-bit BGR, grey ones too. Empty, with `problem` set, on failure.
cv::Mat color_of(const BagImage& image, std::string& problem);
cv::Mat color_of(const BagCompressedImage& image, std::string& problem);

/// Depth in units of `units_m`, 0 = no return. 16-bit images are kept as they are, in
/// `units_of_16_bit_m`; floating-point metres are rounded to 0.2 mm (13.1 m at most, as TUM's
/// images are).
struct BagDepth {
  mrpt::math::CMatrix_u16 values;
  float units_m = 0.001F;
};
bool depth_of(const BagImage& image, float units_of_16_bit_m, BagDepth& depth,
              std::string& problem);
bool depth_of(const BagCompressedImage& image, float units_of_16_bit_m, BagDepth& depth,
              std::string& problem);

}  // namespace rovigo::slam
