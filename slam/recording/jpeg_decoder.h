#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

namespace rovigo::slam {

/// Decodes an 8-bit JPEG of known size (from `inspect_image`), colour or grey, to BGR. libjpeg is
/// used by itself because through OpenCV (which prints) or MRPT (which ends the process) damage
/// cannot be handled; here every complaint of the library, warnings too, makes the result empty and
/// sets `problem`.
cv::Mat decode_jpeg(std::string_view bytes, int width, int height, std::string& problem);

}  // namespace rovigo::slam
