#include "slam/recording/images.h"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "slam/recording/jpeg_decoder.h"

namespace rovigo::slam {
namespace {

constexpr int kMaxSide_px = 8192;
constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);

std::uint32_t big_endian_32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

int big_endian_16(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]) << 8 | static_cast<unsigned char>(bytes[at + 1]);
}

std::string size_problem(long long width, long long height) {
  if (width < 1 || height < 1) return "an image without pixels";
  if (width > kMaxSide_px || height > kMaxSide_px) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels are more than " +
           std::to_string(kMaxSide_px) + " a side";
  }
  return {};
}

std::string read_png_header(std::string_view data, EncodedImage& image) {
  if (data.size() != 13) return "a damaged PNG header";
  const std::uint32_t width = big_endian_32(data, 0);
  const std::uint32_t height = big_endian_32(data, 4);
  if (std::string problem = size_problem(width, height); !problem.empty()) return problem;
  constexpr std::array<int, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};  // by PNG colour type
  const auto color_type = static_cast<unsigned char>(data[9]);
  if (color_type >= kChannels.size() || kChannels[color_type] == 0) return "a damaged PNG header";
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.bits = static_cast<unsigned char>(data[8]);
  image.channels = kChannels[color_type];
  return {};
}

/// PNG (ISO 15948): signature, then chunks of length, type, data, CRC-32 of type and data.
std::string walk_png(std::string_view bytes, EncodedImage& image) {
  bool has_data = false;
  std::size_t at = kPngSignature.size();
  while (bytes.size() - at >= 12) {
    const std::size_t length = big_endian_32(bytes, at);
    if (length > bytes.size() - at - 12) return "a PNG cut short";
    const std::string_view type = bytes.substr(at + 4, 4);
    const std::string_view checked = bytes.substr(at + 4, 4 + length);
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    if (crc != big_endian_32(bytes, at + 8 + length)) return "a PNG whose checksum fails";
    const bool is_first = at == kPngSignature.size();
    if (is_first != (type == "IHDR")) return "a PNG without a header";
    if (is_first) {
      if (std::string problem = read_png_header(checked.substr(4), image); !problem.empty()) {
        return problem;
      }
    }
    if (type == "IDAT") has_data = true;
    if (type == "IEND") return has_data ? std::string() : "a PNG without pixels";
    at += 12 + length;
  }
  return "a PNG cut short";
}

bool is_start_of_frame(int marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// JPEG (ITU T.81): markers with lengths up to the first scan; the end-of-image marker must stand
/// in the last bytes (some cameras pad with a few zeros).
std::string walk_jpeg(std::string_view bytes, EncodedImage& image) {
  constexpr std::size_t kPadding = 32;
  const std::string_view tail = bytes.substr(bytes.size() - std::min(bytes.size(), kPadding));
  if (tail.rfind("\xFF\xD9") == std::string_view::npos) return "a JPEG cut short";
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (static_cast<unsigned char>(bytes[at]) != 0xFF) return "a damaged JPEG header";
    const int marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const auto length = static_cast<std::size_t>(big_endian_16(bytes, at + 2));
    if (length < 2 || length > bytes.size() - at - 2) return "a JPEG cut short";
    if (is_start_of_frame(marker)) {
      if (length < 8) return "a damaged JPEG header";
      image.bits = static_cast<unsigned char>(bytes[at + 4]);
      image.height = big_endian_16(bytes, at + 5);
      image.width = big_endian_16(bytes, at + 7);
      image.channels = static_cast<unsigned char>(bytes[at + 9]);
      return size_problem(image.width, image.height);
    }
    at += 2 + length;
  }
  return "a JPEG without pixels";
}

cv::Mat as_row(std::string_view bytes) {
  // imdecode only reads; its signature is older than const.
  return {1, static_cast<int>(bytes.size()), CV_8UC1,
          const_cast<char*>(bytes.data())};  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

bool decode(std::string_view bytes, int flags, cv::Mat& image) {
  try {
    cv::imdecode(as_row(bytes), flags, &image);
  } catch (const cv::Exception&) {
    return false;
  }
  return !image.empty();
}

}  // namespace

cv::Mat color_view(const mrpt::obs::CObservation3DRangeScan& scan) {
  if (!scan.hasIntensityImage || scan.intensityImage.isEmpty()) return {};
  return scan.intensityImage.asCvMatRef();
}

cv::Mat depth_view(const mrpt::obs::CObservation3DRangeScan& scan) {
  const auto& range = scan.rangeImage;
  if (!scan.hasRangeImage || range.rows() == 0 || range.cols() == 0) return {};
  return {static_cast<int>(range.rows()), static_cast<int>(range.cols()), CV_16UC1,
          const_cast<std::uint16_t*>(range.data())};  // a view; cv::Mat knows no const
}

cv::Mat depth_in_metres(const mrpt::obs::CObservation3DRangeScan& scan) {
  cv::Mat metres;
  const cv::Mat depth = depth_view(scan);
  if (!depth.empty()) depth.convertTo(metres, CV_32FC1, scan.rangeUnits);
  return metres;
}

EncodedImage inspect_image(std::string_view bytes) {
  EncodedImage image;
  if (bytes.empty()) {
    image.problem = "an empty file";
  } else if (bytes.starts_with(kPngSignature)) {
    image.kind = EncodedImage::Kind::kPng;
    image.problem = walk_png(bytes, image);
  } else if (bytes.starts_with("\xFF\xD8")) {
    image.kind = EncodedImage::Kind::kJpeg;
    image.problem = walk_jpeg(bytes, image);
  } else {
    image.problem = "neither PNG nor JPEG";
  }
  return image;
}

cv::Mat decode_color(std::string_view bytes, std::string& problem) {
  const EncodedImage header = inspect_image(bytes);
  problem = header.problem;
  if (problem.empty() && header.bits != 8) {
    problem = std::to_string(header.bits) + " bits per channel where colour has 8";
  }
  if (!problem.empty()) return {};
  if (header.kind == EncodedImage::Kind::kJpeg) {
    return decode_jpeg(bytes, header.width, header.height, problem);
  }
  cv::Mat image;
  if (!decode(bytes, cv::IMREAD_COLOR, image)) problem = "an image that does not decode";
  return image;
}

bool decode_depth(std::string_view bytes, mrpt::math::CMatrix_u16& depth, std::string& problem) {
  const EncodedImage header = inspect_image(bytes);
  problem = header.problem;
  if (problem.empty() &&
      (header.kind != EncodedImage::Kind::kPng || header.bits != 16 || header.channels != 1)) {
    problem = "not a 16-bit grey PNG, as depth must be";
  }
  if (!problem.empty()) return false;
  depth.resize(header.height, header.width);
  cv::Mat image(header.height, header.width, CV_16UC1, depth.data());
  if (!decode(bytes, cv::IMREAD_UNCHANGED, image) || image.type() != CV_16UC1) {
    problem = "an image that does not decode";
    return false;
  }
  if (image.data != reinterpret_cast<const uchar*>(depth.data())) {  // OpenCV chose new memory
    std::memcpy(depth.data(), image.data, image.total() * image.elemSize());
  }
  return true;
}

}  // namespace rovigo::slam
