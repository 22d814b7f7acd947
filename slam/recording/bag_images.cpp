#include "slam/recording/bag_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "slam/recording/byte_cursor.h"
#include "slam/recording/images.h"
#include "slam/recording/text_file.h"

namespace rovigo::slam {
namespace {

constexpr std::uint32_t kMaxSide_px = 8192;
constexpr float kFloatDepthUnits_m = 1.0F / 5000;

struct Encoding {
  std::string_view name;
  BagImageKind kind;
  int cv_type;
  int to_bgr;  ///< cv::ColorConversionCodes; -1: it is BGR
};

constexpr int kIsBgr = -1;
// sensor_msgs/image_encodings.h, and what RealSense calls the same. RealSense's recorder writes
// depth as mono16.
constexpr Encoding kEncodings[] = {
    {"rgb8", BagImageKind::kColor, CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgr8", BagImageKind::kColor, CV_8UC3, kIsBgr},
    {"8UC3", BagImageKind::kColor, CV_8UC3, kIsBgr},
    {"rgba8", BagImageKind::kColor, CV_8UC4, cv::COLOR_RGBA2BGR},
    {"bgra8", BagImageKind::kColor, CV_8UC4, cv::COLOR_BGRA2BGR},
    {"yuv422", BagImageKind::kColor, CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", BagImageKind::kColor, CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"YUYV", BagImageKind::kColor, CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {"mono8", BagImageKind::kGrey, CV_8UC1, cv::COLOR_GRAY2BGR},
    {"8UC1", BagImageKind::kGrey, CV_8UC1, cv::COLOR_GRAY2BGR},
    {"16UC1", BagImageKind::kDepth, CV_16UC1, kIsBgr},
    {"mono16", BagImageKind::kDepth, CV_16UC1, kIsBgr},
    {"32FC1", BagImageKind::kDepth, CV_32FC1, kIsBgr},
};

const Encoding* find_encoding(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kEncodings), std::end(kEncodings),
                                         [&](const Encoding& e) { return e.name == name; });
  return found == std::end(kEncodings) ? nullptr : found;
}

/// The pixels in place, when the sizes in the message agree with each other.
cv::Mat view_of(const BagImage& image, const Encoding& encoding, std::string& problem) {
  const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
  if (image.width < 1 || image.height < 1 || image.width > kMaxSide_px ||
      image.height > kMaxSide_px) {
    problem = "its size " + size + " is outside 1 .. 8192 pixels a side";
    return {};
  }
  const std::uint64_t row_bytes =
      std::uint64_t{image.width} * static_cast<std::uint64_t>(CV_ELEM_SIZE(encoding.cv_type));
  const std::uint64_t all_bytes = std::uint64_t{image.step} * image.height;
  if (image.step < row_bytes || all_bytes != image.data.size()) {
    problem = "it holds " + std::to_string(image.data.size()) + " bytes where " + size +
              " pixels of " + image.encoding + " in rows of " + std::to_string(image.step) +
              " bytes need " + std::to_string(std::max(all_bytes, row_bytes * image.height));
    return {};
  }
  const bool is_wide = CV_ELEM_SIZE1(encoding.cv_type) > 1;
  if (is_wide && image.is_big_endian) {
    problem = "its values are big-endian, which is not supported";
    return {};
  }
  return {static_cast<int>(image.height), static_cast<int>(image.width), encoding.cv_type,
          const_cast<char*>(image.data.data()), image.step};
}

/// Messages are not aligned: rows are copied as bytes before anything reads wider values.
cv::Mat aligned_copy(const cv::Mat& view) {
  cv::Mat copy(view.size(), view.type());
  for (int row = 0; row < view.rows; ++row) {
    const uchar* const from = view.data + static_cast<std::size_t>(row) * view.step[0];
    std::copy(from, from + static_cast<std::size_t>(view.cols) * view.elemSize(), copy.ptr(row));
  }
  return copy;
}

void copy_values(const cv::Mat& from, mrpt::math::CMatrix_u16& to) {
  to.resize(from.rows, from.cols);
  for (int row = 0; row < from.rows; ++row) {
    const auto* const values = from.ptr<std::uint16_t>(row);
    std::copy(values, values + from.cols, &to(row, 0));
  }
}

std::uint16_t units_of(float metres) {
  const float units = metres / kFloatDepthUnits_m;  // NaN and infinity mean no return
  constexpr auto kLargest = static_cast<float>(std::numeric_limits<std::uint16_t>::max());
  return units >= 0.5F && units <= kLargest ? static_cast<std::uint16_t>(std::lround(units)) : 0;
}

/// compressed_depth_image_transport keeps 32FC1 as inverse depth: v = a / z + b.
void expand_inverse_depth(float a, float b, mrpt::math::CMatrix_u16& values) {
  for (int row = 0; row < values.rows(); ++row) {
    for (int column = 0; column < values.cols(); ++column) {
      std::uint16_t& value = values(row, column);
      if (value != 0) value = units_of(a / (static_cast<float>(value) - b));
    }
  }
}

}  // namespace

BagImageKind kind_of_encoding(std::string_view encoding) {
  const Encoding* const found = find_encoding(encoding);
  return found == nullptr ? BagImageKind::kOther : found->kind;
}

cv::Mat color_of(const BagImage& image, std::string& problem) {
  const Encoding* const encoding = find_encoding(image.encoding);
  if (encoding == nullptr || encoding->kind == BagImageKind::kDepth) {
    problem = "its encoding " + shown_text(image.encoding) +
              " is none of rgb8, bgr8, rgba8, bgra8, yuv422 and mono8";
    return {};
  }
  const cv::Mat view = view_of(image, *encoding, problem);
  if (view.empty()) return {};
  if (encoding->to_bgr == kIsBgr) return view.clone();
  if (view.channels() == 2 && view.cols % 2 != 0) {
    problem = "its width is odd, which its encoding does not allow";
    return {};
  }
  cv::Mat bgr;
  cv::cvtColor(view, bgr, encoding->to_bgr);
  return bgr;
}

cv::Mat color_of(const BagCompressedImage& image, std::string& problem) {
  return decode_color(image.data, problem);
}

bool depth_of(const BagImage& image, float units_of_16_bit_m, BagDepth& depth,
              std::string& problem) {
  const Encoding* const encoding = find_encoding(image.encoding);
  if (encoding == nullptr || encoding->kind != BagImageKind::kDepth) {
    problem = "its encoding " + shown_text(image.encoding) + " is neither 16UC1 nor 32FC1";
    return false;
  }
  const cv::Mat view = view_of(image, *encoding, problem);
  if (view.empty()) return false;
  cv::Mat values = aligned_copy(view);
  depth.units_m = units_of_16_bit_m;
  if (encoding->cv_type == CV_32FC1) {
    cv::Mat units(values.size(), CV_16UC1);
    std::transform(values.begin<float>(), values.end<float>(), units.begin<std::uint16_t>(),
                   units_of);
    values = units;
    depth.units_m = kFloatDepthUnits_m;
  }
  copy_values(values, depth.values);
  return true;
}

bool depth_of(const BagCompressedImage& image, float units_of_16_bit_m, BagDepth& depth,
              std::string& problem) {
  std::string_view png = image.data;
  float a = 0.0F;
  float b = 0.0F;
  if (image.format.find("compressedDepth") != std::string::npos) {
    ByteCursor cursor(png);
    cursor.number<std::uint32_t>();
    a = cursor.number<float>();
    b = cursor.number<float>();
    png = cursor.take(cursor.left());
  }
  if (!decode_depth(png, depth.values, problem)) return false;
  const bool is_inverse = image.format.starts_with("32FC1");
  depth.units_m = is_inverse ? kFloatDepthUnits_m : units_of_16_bit_m;
  if (is_inverse) expand_inverse_depth(a, b, depth.values);
  return true;
}

}  // namespace rovigo::slam
