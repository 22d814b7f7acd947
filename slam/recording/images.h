#pragma once
// Images of an observation as OpenCV sees them, and encoded images checked before they are decoded.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

namespace rovigo::slam {

/// The colour image, 8-bit BGR (the readers make three channels of grey), as a view: no copy, valid
/// while `scan` lives and its image is not replaced. Empty when the observation has none. Not to be
/// written to.
cv::Mat color_view(const mrpt::obs::CObservation3DRangeScan& scan);

/// The depth image, CV_16UC1 in units of `scan.rangeUnits` metres, 0 = no return, as a view like
/// `color_view`.
cv::Mat depth_view(const mrpt::obs::CObservation3DRangeScan& scan);

/// The depth in metres, CV_32FC1, 0 = no return. A copy.
cv::Mat depth_in_metres(const mrpt::obs::CObservation3DRangeScan& scan);

/// What the header of an encoded image says; `problem` is empty when the file is whole.
struct EncodedImage {
  enum class Kind { kUnknown, kPng, kJpeg };
  Kind kind = Kind::kUnknown;
  int width = 0;
  int height = 0;
  int bits = 0;      ///< per channel
  int channels = 0;  ///< as stored
  std::string problem;
};

/// Looks through a PNG (every chunk and its checksum) or JPEG (markers, end of image) without
/// decoding it. Decoders print to the terminal on damage and fill the rest with grey; this says
/// beforehand what is wrong. Images beyond 8192 pixels a side are refused.
EncodedImage inspect_image(std::string_view bytes);

/// Decodes an 8-bit PNG or JPEG to BGR, grey ones too. On failure the result is
/// empty and `problem` says why.
cv::Mat decode_color(std::string_view bytes, std::string& problem);

/// Decodes a depth image (16-bit, one channel, PNG) into `depth`, whose memory is used again when
/// its size fits. False, with `problem` set, on failure.
bool decode_depth(std::string_view bytes, mrpt::math::CMatrix_u16& depth, std::string& problem);

}  // namespace rovigo::slam
