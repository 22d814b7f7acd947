#include "maps/stored_image.h"

#include <opencv2/imgcodecs.hpp>

#include "maps/error.h"
#include "maps/gray_image.h"

namespace rovigo::maps {
namespace {

cv::Mat decode(const StoredKeyframe& keyframe, const Blob& bytes, bool is_whole, int flags,
               int type, const char* what) {
  cv::Mat image;
  try {
    if (is_whole) image = cv::imdecode(bytes, flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (!image.empty() && image.type() == type) return image;
  throw InputError("keyframe " + std::to_string(keyframe.id) + " of the map has a " + what +
                   " image that cannot be decoded");
}

}  // namespace

cv::Mat decode_depth(const StoredKeyframe& keyframe) {
  const Blob& png = keyframe.depth_png;
  const std::string_view bytes(reinterpret_cast<const char*>(png.data()), png.size());
  return decode(keyframe, png, png_problem(bytes).empty(), cv::IMREAD_UNCHANGED, CV_16UC1, "depth");
}

cv::Mat decode_color(const StoredKeyframe& keyframe) {
  if (keyframe.color_jpeg.empty()) return {};
  return decode(keyframe, keyframe.color_jpeg, true, cv::IMREAD_COLOR, CV_8UC3, "colour");
}

}  // namespace rovigo::maps
