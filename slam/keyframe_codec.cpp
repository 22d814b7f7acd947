#include "slam/keyframe_codec.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "maps/error.h"

namespace rovigo::slam {

namespace {

// Layout, little-endian: magic, version, count (u32 each), then `count` records of kRecordBytes.
constexpr std::uint32_t kMagic = 0x46565652;  // "RVVF"
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kRecordBytes = 4 * 4 + 4 + 4 + 4 * 4 + 32;
constexpr std::uint32_t kMostFeatures = 100000;

static_assert(std::endian::native == std::endian::little,
              "blobs are written as they lie in memory");

template <class T>
void put(maps::Blob& blob, const T& value) {
  const std::size_t at = blob.size();
  blob.resize(at + sizeof(T));
  std::memcpy(blob.data() + at, &value, sizeof(T));
}

template <class T>
T take(const maps::Blob& blob, std::size_t& at) {
  T value;
  std::memcpy(&value, blob.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

[[noreturn]] void refuse(const std::string& why) {
  throw maps::InputError("A keyframe's features cannot be read: " + why +
                         "; make the map again from its recording.");
}

void check(const StoredFeature& f, std::size_t index) {
  const float values[] = {f.pixel_u, f.pixel_v, f.angle_rad, f.depth_m,
                          f.point_x, f.point_y, f.point_z,   f.sigma_m};
  for (const float v : values) {
    if (!std::isfinite(v) || std::abs(v) > 1e5f) {
      refuse("feature " + std::to_string(index) + " holds the value " + std::to_string(v));
    }
  }
  if (f.octave > 31 || f.landmark < -1 || f.depth_m < 0 || f.sigma_m < 0) {
    refuse("feature " + std::to_string(index) + " is out of range");
  }
}

}  // namespace

maps::Blob encode_features(const std::vector<StoredFeature>& features) {
  maps::Blob blob;
  blob.reserve(kHeaderBytes + features.size() * kRecordBytes);
  put(blob, kMagic);
  put(blob, kVersion);
  put(blob, static_cast<std::uint32_t>(features.size()));
  for (const StoredFeature& f : features) {
    put(blob, f.pixel_u);
    put(blob, f.pixel_v);
    put(blob, f.angle_rad);
    put(blob, f.depth_m);
    put(blob, static_cast<std::uint32_t>(f.octave));
    put(blob, f.landmark);
    put(blob, f.point_x);
    put(blob, f.point_y);
    put(blob, f.point_z);
    put(blob, f.sigma_m);
    put(blob, f.descriptor);
  }
  return blob;
}

std::vector<StoredFeature> decode_features(const maps::Blob& blob) {
  if (blob.size() < kHeaderBytes) refuse(std::to_string(blob.size()) + " bytes are too few");
  std::size_t at = 0;
  if (take<std::uint32_t>(blob, at) != kMagic) refuse("the first bytes are foreign");
  const auto version = take<std::uint32_t>(blob, at);
  if (version != kVersion) refuse("version " + std::to_string(version) + " is not known");
  const auto count = take<std::uint32_t>(blob, at);
  if (count > kMostFeatures || blob.size() != kHeaderBytes + count * kRecordBytes) {
    refuse(std::to_string(count) + " features do not fill " + std::to_string(blob.size()) +
           " bytes");
  }
  std::vector<StoredFeature> features(count);
  for (std::size_t i = 0; i < count; ++i) {
    StoredFeature& f = features[i];
    f.pixel_u = take<float>(blob, at);
    f.pixel_v = take<float>(blob, at);
    f.angle_rad = take<float>(blob, at);
    f.depth_m = take<float>(blob, at);
    const auto octave = take<std::uint32_t>(blob, at);
    if (octave > 31) refuse("feature " + std::to_string(i) + " is out of range");
    f.octave = static_cast<std::uint8_t>(octave);
    f.landmark = take<std::int32_t>(blob, at);
    f.point_x = take<float>(blob, at);
    f.point_y = take<float>(blob, at);
    f.point_z = take<float>(blob, at);
    f.sigma_m = take<float>(blob, at);
    f.descriptor = take<Descriptor>(blob, at);
    check(f, i);
  }
  return features;
}

maps::Blob encode_color(const cv::Mat& color) {
  maps::Blob out;
  if (!color.empty()) cv::imencode(".jpg", color, out, {cv::IMWRITE_JPEG_QUALITY, 85});
  out.shrink_to_fit();  // encoders reserve for the worst case; hundreds of keyframes are kept
  return out;
}

maps::Blob encode_depth(const CameraFrame& frame) {
  maps::Blob out;
  if (frame.depth.empty()) return out;
  cv::Mat thinned((frame.depth.rows + 1) / 2, (frame.depth.cols + 1) / 2, CV_16UC1);
  for (int v = 0; v < thinned.rows; ++v) {
    const auto* from = frame.depth.ptr<std::uint16_t>(2 * v);
    auto* to = thinned.ptr<std::uint16_t>(v);
    for (int u = 0; u < thinned.cols; ++u) to[u] = from[2 * u];
  }
  cv::Mat millimetres;
  thinned.convertTo(millimetres, CV_16U, frame.depth_unit_m * 1000.0);
  cv::imencode(".png", millimetres, out, {cv::IMWRITE_PNG_COMPRESSION, 1});
  out.shrink_to_fit();
  return out;
}

cv::Mat decode_depth(const maps::Blob& png, const cv::Size& size) {
  cv::Mat depth;
  if (!png.empty()) depth = cv::imdecode(png, cv::IMREAD_UNCHANGED);
  if (depth.empty() || depth.type() != CV_16UC1) {
    throw maps::InputError("A keyframe's depth image cannot be read: it is not a 16-bit PNG.");
  }
  cv::Mat full;
  cv::resize(depth, full, size, 0, 0, cv::INTER_NEAREST);
  return full;
}

}  // namespace rovigo::slam
